/// A camera that goes around what it looks at.
#pragma once

#include "alcove/render/camera.h"

#include <vector>

namespace alcove {

/// The line that everything turns about.
struct Axis {
    Vec3d point{0.0};
    Vec3d direction{0.0, 1.0, 0.0}; ///< of any length but 0
};

/// Counterclockwise seen from the end of the axis.
Vec3d turned(const Vec3d& p, const Axis& axis, double degrees);

/// The camera carried around the axis, still with `up` upward.
Camera turned(const Camera& camera, const Axis& axis, double degrees);

/// Where the points come while they turn, every fifteen degrees: what a camera must see to see them in all frames.
std::vector<Vec3d> swept(std::span<const Vec3d> points, const Axis& axis);

}
