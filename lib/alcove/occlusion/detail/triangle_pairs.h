/// Pairs triangles into quads, which halves the number of primitives in a BVH.
#pragma once

#include "alcove/base/types.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alcove {

/// Whether a ray can hit the triangle: all corners are distinct and finite.
bool can_be_hit(std::span<const Vec3> positions, const Triangle& triangle);

/// The triangles (0, 1, 3) and (2, 3, 1); the second is degenerate if a triangle has no partner.
using TrianglePair = std::array<std::uint32_t, 4>;

/// Every triangle once, paired with an edge neighbour if one comes shortly before it in the list. Skips triangles that
/// no ray can hit. Corner indices must be in range. Cost: about 30 ns per triangle.
std::vector<TrianglePair> pair_triangles(std::span<const Vec3> positions, std::span<const Triangle> triangles);

}
