/// The checksum by which a grid of our own tells whether it is still what was written. Internal to grid/.
#pragma once

#include "alcove/grid/grid_stack.h"

#include <cstdint>

namespace alcove {

/// CRC-32 (of zlib, J. Gailly and M. Adler 2022) of all that scales and places the grid and of its values: its class and `alcove:*`
/// metadata but for `alcove:checksum`, the matrix of its transform, the background, and for every node where it is,
/// which values are active and all of them. The same whatever the compression of its file. Damage of up to 32 bits
/// in a row is always found, other damage but for one time in 2³². Thread-safe; by threads of parallel_for.
std::uint32_t checksum_of(const VdbGrid& grid);

}
