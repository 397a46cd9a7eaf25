/// CPU seconds of what is done here and by programs, in turns: the clock of a shared machine changes over minutes.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace alcove::docs {

/// CPU seconds of all threads of this process, of the second time in a row: the first pays for memory that the machine
/// has taken back meanwhile.
double warm_cpu_seconds_of(const std::function<void()>& work);

/// Of each, the median of `rounds` in which they take turns. They return what they took.
std::vector<double> medians(const std::vector<std::function<double()>>& takers, int rounds = 5);

/// A program that has ended well.
struct Run {
    double cpu_seconds = 0.0, wall_seconds = 0.0;
    std::string output; ///< stdout
};

/// \throw std::runtime_error where it does not end with 0.
Run run(const std::vector<std::string>& command);

}
