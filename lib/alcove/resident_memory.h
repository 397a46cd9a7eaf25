/// What the process has taken of the machine's memory. Internal.
#pragma once

#include <cstddef>

namespace alcove {

/// The most bytes that were resident at once since the program began or the peak was forgotten; 0 where the system does
/// not tell. Not of the program that started this one, which getrusage() counts in.
std::size_t peak_resident_bytes();

/// From now on the peak is that of what follows.
void forget_peak_resident_bytes();

}
