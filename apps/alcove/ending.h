/// How the program ends early: no partial file is left behind.
#pragma once

#include <optional>

namespace alcove::cli {

inline constexpr const char* out_of_memory = "out of memory: use a coarser --voxel";

/// Installs handlers: a signal that ends the program, such as SIGINT, first removes unfinished files. So does an
/// exception that nothing can catch, usually std::bad_alloc in a library; the program then ends with one line and exit
/// code 1. A file that exceeds the size limit is an error, as a full disk is.
void end_cleanly();

/// Call before the program prints its last line, an error or a result: afterwards, neither the time limit nor a failure
/// adds a line. Waits for ever if another thread is already ending the program.
void begin_to_end();

/// Ends the program after this many seconds, > 0, with one line and exit code 1, and removes unfinished files. The
/// last call wins.
void limit_time(double seconds);

/// Wall-clock seconds until the limit, at least 0; empty without a limit.
std::optional<double> seconds_left();

}
