/// Groups of fragments that lie near one another. Internal to grid/.
#pragma once

#include "alcove/base/detail/morton_sort.h"

#include <cstdint>
#include <span>

namespace alcove {

using FragmentKey =
    Keyed<std::uint32_t>; ///< the cell that a fragment is in as a morton_code(), and the fragment

inline constexpr std::uint32_t largest_leaf = 8;
inline constexpr double most_cells_per_voxel = 4.0;

/// Puts fragments, in the order of their keys, in an order in which those of a group follow one another. Returns where
/// groups begin, and the end of the last. Neither depends on the number of threads. Cost: linear, about 20 ns a fragment.
/// \pre keys have ten bits a coordinate, and there are at most most_cells_per_voxel
HugeVector<std::uint32_t> group_fragments(std::span<FragmentKey> fragments, double cells_per_voxel);

}
