/// The point of a triangle that is closest to another point.
#pragma once

#include "alcove/base/types.h"

namespace alcove {

struct ClosestPoint {
    Vec3d offset; ///< from the closest point to the other
    /// The part of the triangle on which the closest point lies: 0..2 a corner, 3..5 the edge from corner feature − 3
    /// to the next one, 6 the face.
    int feature;
};
inline constexpr int face_feature = 6;

/// Source: Ericson (2005).
ClosestPoint closest_on_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p);

}
