/// How the program ends before its time: without a part of a file left behind.
#pragma once

#include <optional>

namespace alcove::cli {

inline constexpr const char* out_of_memory = "out of memory: use a coarser --voxel";

/// From now on a signal that ends the program, as SIGINT does, first removes what is not written to its end. What a
/// library throws where nothing can catch it, too little memory as a rule, does so too, and becomes one line and exit
/// code 1. A file that grows over a limit is an error like that of a full disk.
void end_cleanly();

/// After so many seconds, > 0, the program says so in one line and ends with exit code 1, as cleanly. The last call counts.
void limit_time(double seconds);

struct TimeLimit {
    double seconds; ///< in all
    double left;    ///< wall clock, ≥ 0
};

/// The one that was set, if one was.
std::optional<TimeLimit> time_limit();

}
