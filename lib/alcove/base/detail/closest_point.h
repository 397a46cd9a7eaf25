/// Finds the point of a triangle that is closest to a query point.
#pragma once

#include "alcove/base/types.h"

namespace alcove {

struct ClosestPoint {
    Vec3d offset; ///< from the closest point to the query point
    /// The part of the triangle on which the closest point lies: 0..2 a corner, 3..5 the edge from corner `feature` − 3
    /// to the next corner, 6 the interior.
    int feature;
};
inline constexpr int face_feature = 6;

/// The point of the triangle a, b, c that is closest to `p` (Ericson 2005).
ClosestPoint closest_on_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p);

}
