#include "alcove/scene/detail/support.h"

#include <algorithm>
#include <cmath>

namespace alcove {

std::optional<double> support(const Shape& shape, const Pose& pose, const Vec3d& direction) {
    const Vec3d u = glm::transpose(pose.rotation) * direction; // in the space of the shape
    const auto at = [&](const Vec3d& p, double further) { return glm::dot(direction, pose(p)) + pose.scale * further; };
    if (const auto* sphere = std::get_if<SphereShape>(&shape))
        return at(sphere->center, sphere->radius);
    if (const auto* box = std::get_if<BoxShape>(&shape))
        return at(box->center, glm::dot(glm::abs(u), 0.5 * box->size));
    if (const auto* torus = std::get_if<TorusShape>(&shape))
        return at(torus->center, torus->ring * std::sqrt(std::max(0.0, 1.0 - u.y * u.y)) + torus->tube);
    if (const auto* capsule = std::get_if<CapsuleShape>(&shape))
        return std::max(at(capsule->start, capsule->radius), at(capsule->end, capsule->radius));
    return {};
}

Box box_of(const Shape& shape, const Pose& pose) {
    Box box;
    if (!support(shape, pose, {1.0, 0.0, 0.0}))
        return box;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3d direction(0.0);
        direction[axis] = 1.0;
        box.max[axis] = *support(shape, pose, direction);
        box.min[axis] = -*support(shape, pose, -direction);
    }
    return box;
}

}
