#include "alcove/render/detail/turntable.h"

#include <cmath>
#include <numbers>

namespace alcove {
namespace {

/// Rotates a direction (Rodrigues 1840).
Vec3d turned_direction(const Vec3d& v, const Vec3d& axis, double degrees) {
    const Vec3d k = glm::normalize(axis);
    const double angle = degrees * std::numbers::pi / 180.0, c = std::cos(angle), s = std::sin(angle);
    return c * v + s * glm::cross(k, v) + (1.0 - c) * glm::dot(k, v) * k;
}

}

Vec3d turned(const Vec3d& p, const Axis& axis, double degrees) {
    return axis.point + turned_direction(p - axis.point, axis.direction, degrees);
}

Camera turned(const Camera& camera, const Axis& axis, double degrees) {
    const Vec3d eye = turned(camera.eye(), axis, degrees);
    const Vec3d forward = turned_direction(camera.forward(), axis.direction, degrees);
    const double reach = std::max(1.0, glm::length(eye)); // large enough to survive rounding in the sum
    return Camera(eye, eye + reach * forward, turned_direction(camera.up(), axis.direction, degrees), camera.fov(),
                  camera.size());
}

std::vector<Vec3d> swept(std::span<const Vec3d> points, const Axis& axis) {
    std::vector<Vec3d> all;
    for (int degrees = 0; degrees < 360; degrees += 15)
        for (const Vec3d& p : points)
            all.push_back(turned(p, axis, degrees));
    return all;
}

}
