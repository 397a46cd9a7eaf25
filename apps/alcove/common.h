/// What all verbs share: their common options, how they warn, time and report.
#pragma once

#include "progress.h"

#include <nlohmann/json_fwd.hpp>

#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace alcove::cli {

/// The command line cannot be meant: exit code 2.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct CommonOptions {
    unsigned threads = 0;
    bool json = false;
    bool quiet = false;
    ProgressMode progress = ProgressMode::automatic;

    ProgressMode progress_mode() const { return quiet ? ProgressMode::none : progress; }
};

/// Adds --threads, --progress, --time-limit, --quiet, --version to a verb.
void add_run_options(CLI::App& verb, CommonOptions& options);

/// Those and --json.
void add_common_options(CLI::App& verb, CommonOptions& options);

/// Prints warnings to stderr, a line each, unless quiet; where stderr takes nothing they are lost.
void print_warnings(const std::vector<std::string>& warnings, const CommonOptions& options);

/// The extension of a file's name in lower case, with its dot.
std::string extension(const std::string& file);

/// Prints the object on stdout.
void print_json(const nlohmann::ordered_json& object);

/// Wall-clock seconds since it was made or last asked.
class Stopwatch {
  public:
    double lap();

  private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

// The verbs: each adds itself to the program, with the work as its callback.
void add_bake(CLI::App& program);
void add_render(CLI::App& program);
void add_voxelize(CLI::App& program);
void add_info(CLI::App& program);
void add_measure(CLI::App& program);
void add_methods(CLI::App& program);

}
