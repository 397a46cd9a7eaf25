/// Triangles two by two: half as many primitives for a hierarchy to sort. Internal.
#pragma once

#include "alcove/base/types.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alcove {

/// The triangles (0, 1, 3) and (2, 3, 1); the second is degenerate where a triangle stands alone.
using TrianglePair = std::array<std::uint32_t, 4>;

/// Every triangle once, with a neighbour over an edge where the file has one not far before it. Those that no
/// ray can meet are left out: with a corner that is twice there or not finite. Corners must name positions.
/// Cost: about 30 ns a triangle.
std::vector<TrianglePair> pair_triangles(std::span<const Vec3> positions,
                                         std::span<const Triangle> triangles);

}
