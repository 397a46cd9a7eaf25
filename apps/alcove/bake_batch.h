/// Several inputs of one run: their outputs, and the handling of failures.
#pragma once

#include "options.h"

#include "alcove/bake/bake.h"

#include <functional>

namespace alcove::cli {

struct BatchFile {
    std::string input, output;
};

/// Names one output per input. `output` is a file (one input only) or a folder, which is created if missing. In a
/// folder, outputs are named after their inputs: .ply, .obj, .glb and .gltf keep their extension, everything else
/// becomes .ply. If inputs have the same name, their outputs are prefixed with the names of their folders. \throw
/// UsageError if there are several inputs but no folder, if two outputs would have the same name, or if an output would
/// replace an input; IoError if the folder cannot be created.
std::vector<BatchFile> batch_files(const std::vector<std::string>& inputs, const std::string& output);

/// Runs `work` for each file with one progress display. With several files, a failure is reported and the next file
/// follows. \throw what `work` throws if there is a single file; BatchError if any of several files failed.
void run_batch(const std::vector<BatchFile>& files, const CommonOptions& common,
               const std::function<void(const BatchFile&, const BakeProgress&)>& work);

/// Thrown if some files of a batch failed. Each failure has already been reported.
struct BatchError : std::runtime_error {
    BatchError(const std::string& message, bool bad) : std::runtime_error(message), bad_input(bad) {}
    bool bad_input; ///< at least one input was invalid or too large
};

}
