/// Support functions and boxes of analytic shapes.
#pragma once

#include "alcove/scene/detail/pose.h"

#include <optional>

namespace alcove {

/// The largest p·direction over all points p of a posed sphere, box, torus or capsule; empty for other shapes.
/// `direction` has unit length. Exact.
std::optional<double> support(const Shape& shape, const Pose& pose, const Vec3d& direction);

/// The box around such a shape; empty for other shapes.
Box box_of(const Shape& shape, const Pose& pose);

}
