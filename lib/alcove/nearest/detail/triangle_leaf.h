/// Makes groups of triangles. Internal to grid/.
#pragma once

#include "alcove/nearest/detail/triangle_tree.h"

namespace alcove {

/// Of eight triangles, from the origin of their group.
struct Corners {
    alignas(32) float a[3][TriangleLeaf::size];
    alignas(32) float ab[3][TriangleLeaf::size], ac[3][TriangleLeaf::size]; ///< to the others from a
};

/// Sets the frames of a group, whose origin is set. The bounds are as tight as rounding lets them be, without a child.
Bounds set_frames(const Corners& corners, TriangleLeaf& group);

inline Vec3 unit_or_z(const Vec3& v) {
    const float length = glm::length(v);
    return length > 0.0f ? v / length : Vec3(0, 0, 1);
}

}
