/// The measurements in a JSON file, so that a run that was cut off goes on where it was.
#pragma once

#include "alcove/measure/measure.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace alcove::cli {

/// What makes a measurement the one that was asked for: mesh, its size in bytes, method, samples, radius and voxel
/// as they were given, version.
using Asked = nlohmann::ordered_json;

class MeasuredResults {
  public:
    /// Reads what the file holds, if there is one; an empty name keeps everything in memory. \throw InputError
    /// if the file is there and is none of ours; IoError if nothing can be written there.
    explicit MeasuredResults(std::string file);

    /// Null if it was not measured yet.
    const Measurement* find(const Asked& asked) const;
    /// Keeps it, and writes the file whole. Results of other inputs stay in it. \throw IoError.
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
