/// How far shapes without a file reach.
#pragma once

#include "alcove/scene/detail/pose.h"

#include <optional>

namespace alcove {

/// The largest p·direction of all points p of a posed sphere, box, torus or capsule; nothing for other shapes. `direction` is
/// of unit length. Exact.
std::optional<double> support(const Shape& shape, const Pose& pose, const Vec3d& direction);

/// The box around such a shape; empty for others.
Box box_of(const Shape& shape, const Pose& pose);

}
