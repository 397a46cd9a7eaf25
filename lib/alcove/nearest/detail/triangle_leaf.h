/// Fills the leaves of a TriangleTree.
#pragma once

#include "alcove/nearest/detail/triangle_tree.h"

namespace alcove {

/// The corners of eight triangles, relative to the origin of their leaf.
struct Corners {
    alignas(32) float a[3][TriangleLeaf::size];
    alignas(32) float ab[3][TriangleLeaf::size], ac[3][TriangleLeaf::size]; ///< from a to the other corners
};

/// Sets the frames of a leaf, whose origin must be set. Returns bounds without a margin for rounding and without a
/// child.
Bounds set_frames(const Corners& corners, TriangleLeaf& leaf);

inline Vec3 unit_or_z(const Vec3& v) {
    const float length = glm::length(v);
    return length > 0.0f ? v / length : Vec3(0, 0, 1);
}

}
