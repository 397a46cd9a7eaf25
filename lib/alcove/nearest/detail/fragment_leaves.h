/// Groups fragments that are near one another into leaves.
#pragma once

#include "alcove/base/detail/morton_sort.h"

#include <cstdint>
#include <span>

namespace alcove {

/// The cell of a fragment as a morton_code(), and the fragment.
using FragmentKey = Keyed<std::uint32_t>;

inline constexpr std::uint32_t largest_leaf = 8;
inline constexpr double most_cells_per_voxel = 4.0;

/// Reorders fragments, given in the order of their keys, so that the fragments of each leaf are contiguous. Returns the
/// offset of each leaf and the end of the last one. The result does not depend on the number of threads. Cost: linear,
/// about 20 ns per fragment.
/// \pre keys have ten bits per coordinate; cells_per_voxel is at most most_cells_per_voxel
HugeVector<std::uint32_t> group_fragments(std::span<FragmentKey> fragments, double cells_per_voxel);

}
