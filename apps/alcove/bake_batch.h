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
/// folder, outputs are named after their inputs: .obj stays .obj, everything else becomes .ply. Inputs of the same name
/// are prefixed with the name of their folder. \throw UsageError if two outputs would have the same name or an output
/// would replace an input; IoError if the folder cannot be created.
std::vector<BatchFile> batch_files(const std::vector<std::string>& inputs, const std::string& output);

/// Runs `work` for each file with one progress display. With several files, a failure is reported and the others
/// continue. \throw any exception of `work` for a single file; BatchError if any of several files failed.
void run_batch(const std::vector<BatchFile>& files, const CommonOptions& common,
               const std::function<void(const BatchFile&, const BakeProgress&)>& work);

/// Thrown if some files failed. Each failure has been reported.
struct BatchError : std::runtime_error {
    BatchError(const std::string& message, bool bad) : std::runtime_error(message), bad_input(bad) {}
    bool bad_input; ///< at least one input was invalid or too large
};

}
