/// Measurements in a JSON file, so that an interrupted sweep can continue.
#pragma once

#include "alcove/measure/measure.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace alcove {

/// The key of a measurement: the mesh, the size of its file in bytes, the method, its samples, the radius and voxel as
/// the user wrote them, the version, and the weld length if there is one.
using MeasurementKey = nlohmann::ordered_json;

class ResultsFile {
  public:
    /// Reads the file if it exists; an empty name keeps everything in memory. \throw InputError if the file exists but
    /// does not contain measurements; IoError if it cannot be written.
    explicit ResultsFile(std::string file);

    /// The measurement with this key; null if there is none yet.
    const Measurement* find(const MeasurementKey& key) const;
    /// Adds a measurement and rewrites the file. Measurements that the file already contains stay in it. \throw IoError
    /// if the file cannot be written.
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
