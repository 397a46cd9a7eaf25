/// Removes duplicate (double-sided) faces.
#pragma once

#include "alcove/base/types.h"

#include <span>
#include <vector>

namespace alcove {

/// Which triangles with the same three corners count as duplicates of each other.
enum class Duplicates {
    of_either_side, ///< all of them; if both sides of a sheet are modelled, the first face decides the sign
    of_one_side,    ///< only those with the same orientation
};

/// Keeps only the first triangle of each set of duplicates. Preserves the order of the triangles. Compares positions
/// exactly. Cost: about 50 ns per triangle. Defined for Vec3 and Vec3d.
template <class Position>
std::vector<Triangle> without_duplicate_faces(std::span<const Position> positions, std::span<const Triangle> triangles,
                                              Duplicates duplicates = Duplicates::of_either_side);

/// Whether a fixed sample of the triangles contains duplicates of either side. May miss some: in a million triangles,
/// duplicates that make up less than about 2 %; in more triangles, larger shares, and most duplicates that are
/// neighbours in the list. Cost: at most about two milliseconds.
bool has_duplicates_in_sample(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}
