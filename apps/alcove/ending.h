/// How the program ends early: no partial file is left behind.
#pragma once

#include <optional>

namespace alcove::cli {

inline constexpr const char* out_of_memory = "out of memory: use a coarser --voxel";

/// Installs handlers that remove unfinished files before a signal such as SIGINT ends the program, or an exception that
/// nothing can catch, usually std::bad_alloc in a library. After such an exception, the program ends with one line and
/// exit code 1. A file that exceeds the size limit is an error, as a full disk is.
void end_cleanly();

/// Call before the program prints its last line (an error or a result): after the call, neither the time limit nor a
/// failure adds a line. Never returns if another thread is already ending the program.
void begin_to_end();

/// Sets a limit, > 0, after which the program removes unfinished files and ends with one line and exit code 1. The last
/// call wins.
void limit_time(double seconds);

/// Wall-clock seconds until the limit, at least 0; empty without a limit.
std::optional<double> seconds_left();

}
