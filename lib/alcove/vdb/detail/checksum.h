/// Computes the checksum by which changes of the grids that Alcove wrote are detected.
#pragma once

#include "alcove/grid/grid_stack.h"

#include <cstdint>

namespace alcove {

/// CRC-32 (Gailly and Adler 2022) of everything that determines the scale, position and values of a grid: its
/// class and `alcove:*` metadata except `alcove:checksum`, the matrix of its transform, the background, and for
/// every node its origin, the mask of its active values and all its values. Independent of the compression of the
/// file. Damage of up to 32 consecutive bits is always detected. Other damage is missed with a probability of 2⁻³².
/// Thread-safe; uses the threads of parallel_for.
std::uint32_t checksum_of(const VdbGrid& grid);

}
