/// Groups of pieces that lie near one another. Internal to grid/.
#pragma once

#include "alcove/radix_sort.h"

#include <cstdint>
#include <span>

namespace alcove {

using PieceKey = Keyed<std::uint32_t>; ///< the cell that a piece is in as a morton_code(), and the piece

inline constexpr std::uint32_t largest_group = 8;
inline constexpr double most_cells_per_voxel = 4.0;

/// Puts pieces, in the order of their keys, in an order in which those of a group follow one another. Returns where
/// groups begin, and the end of the last. Neither depends on the number of threads. Cost: linear, about 20 ns a piece.
/// \pre keys have ten bits a coordinate, and there are at most most_cells_per_voxel
HugeVector<std::uint32_t> group_pieces(std::span<PieceKey> pieces, double cells_per_voxel);

}
