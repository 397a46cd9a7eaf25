/// Measurements in a JSON file, so that an interrupted run can continue.
#pragma once

#include "alcove/measure/measure.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace alcove::cli {

/// The key of a measurement: mesh, its file size in bytes, method, samples, radius and voxel as written on the command
/// line, and version.
using Asked = nlohmann::ordered_json;

class MeasuredResults {
  public:
    /// Reads the file if it exists; an empty name keeps everything in memory. \throw InputError if the file exists but
    /// does not contain measurements; IoError if it cannot be written.
    explicit MeasuredResults(std::string file);

    /// Null if not measured yet.
    const Measurement* find(const Asked& asked) const;
    /// Adds a measurement and rewrites the file. Results of other inputs are kept. \throw IoError.
    void add(const Asked& asked, Measurement measurement);

  private:
    struct Result {
        Asked asked;
        Measurement measurement;
    };
    void write() const;

    std::string file_;
    std::vector<Result> results_;
};

}
