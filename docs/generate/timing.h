/// CPU seconds of work in this process and of other programs. Programs and functions to compare are timed in turns,
/// because the clock rate of a shared machine drifts over minutes.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace alcove::docs {

/// CPU seconds of the second of two calls of `work`, over all threads of this process. The first call pays for memory
/// that the system has reclaimed in the meantime.
double warm_cpu_seconds_of(const std::function<void()>& work);

/// The median of what each timer returns, over `rounds` in which the timers take turns.
std::vector<double> medians(const std::vector<std::function<double()>>& timers, int rounds = 5);

/// A program that ended with exit code 0.
struct Run {
    double cpu_seconds = 0.0, wall_seconds = 0.0;
    std::string output; ///< stdout
};

/// Runs a command. \throw std::runtime_error if the program cannot start or if its exit code is not 0.
Run run(const std::vector<std::string>& command);

}
