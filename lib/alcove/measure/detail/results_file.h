/// Measurements in a JSON file, so that an interrupted sweep can continue.
#pragma once

#include "alcove/measure/measure.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace alcove {

/// The key of a measurement: mesh, its file size in bytes, method, samples, radius and voxel as the user wrote them,
/// and version.
using MeasurementKey = nlohmann::ordered_json;

class ResultsFile {
  public:
    /// Reads the file if it exists; an empty name keeps everything in memory. \throw InputError if the file exists but
    /// does not contain measurements; IoError if it cannot be written.
    explicit ResultsFile(std::string file);

    /// Null if not measured yet.
    const Measurement* find(const MeasurementKey& key) const;
    /// Adds a measurement and rewrites the file. Results of other inputs are kept. \throw IoError if the file cannot be
    /// written.
    void add(const MeasurementKey& key, Measurement measurement);

  private:
    struct Result {
        MeasurementKey key;
        Measurement measurement;
    };
    void write() const;

    std::string file_;
    std::vector<Result> results_;
};

}
