/// Removes duplicate (double-sided) faces.
#pragma once

#include "alcove/base/types.h"

#include <span>
#include <vector>

namespace alcove {

/// Which triangles with the same three corners are duplicates of each other.
enum class Duplicates {
    of_either_side, ///< of any orientation: if both sides of a sheet are modelled, the first face decides the sign
    of_one_side,    ///< those of the same orientation
};

/// Keeps only the first triangle of each set of duplicates. Preserves the order. Positions are compared exactly. Cost:
/// about 50 ns per triangle. Defined for Vec3 and Vec3d.
template <class Position>
std::vector<Triangle> without_duplicate_faces(std::span<const Position> positions, std::span<const Triangle> triangles,
                                              Duplicates duplicates = Duplicates::of_either_side);

/// Whether a sample of the triangles, the same in each call, has duplicates. It misses duplicates that make up less
/// than a few ten-thousandths of all triangles. Cost: at most about two milliseconds.
bool has_duplicates_in_sample(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}
