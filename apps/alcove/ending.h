/// How the program ends before its time: without a part of a file left behind.
#pragma once

namespace alcove::cli {

/// From now on what ends a program by a signal, as SIGINT does, removes what is not written to its end, and then ends it as before; a file
/// that grows over a limit is an error like that of a full disk. So does what libraries throw where nothing can catch it: too
/// little memory, as a rule. It becomes one line and exit code 1.
void end_cleanly();

/// After so many seconds the program says so in one line and ends with exit code 1, as by a signal. > 0; the last call counts.
void limit_time(double seconds);

}
