/// Turntable cameras.
#pragma once

#include "alcove/render/camera.h"

#include <vector>

namespace alcove {

/// An axis of rotation.
struct Axis {
    Vec3d point{0.0};
    Vec3d direction{0.0, 1.0, 0.0}; ///< of any length but 0
};

/// The point rotated about the axis, counterclockwise as seen from its tip.
Vec3d turned(const Vec3d& p, const Axis& axis, double degrees);

/// The camera rotated about the axis.
Camera turned(const Camera& camera, const Axis& axis, double degrees);

/// Copies of the points, rotated in steps of fifteen degrees. A camera that frames all copies frames the points at any
/// angle.
std::vector<Vec3d> swept(std::span<const Vec3d> points, const Axis& axis);

}
