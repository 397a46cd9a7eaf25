#include "alcove/scene/detail/pose.h"

#include <cmath>
#include <numbers>

namespace alcove {
namespace {

/// Counterclockwise rotation about a coordinate axis.
glm::dmat3 turned(int axis, double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    glm::dmat3 m(1.0);
    m[next][next] = m[last][last] = std::cos(angle);
    m[next][last] = std::sin(angle);
    m[last][next] = -m[next][last];
    return m;
}

}

Pose pose_of(const Placement& placement) {
    const Vec3d& r = placement.rotation;
    return {turned(2, r.z) * turned(1, r.y) * turned(0, r.x), placement.scale, placement.translation};
}

Pose operator*(const Pose& outer, const Pose& inner) {
    return {outer.rotation * inner.rotation, outer.scale * inner.scale, outer(inner.translation)};
}

Box posed(const Box& box, const Pose& pose) {
    Box result;
    for (int corner = 0; corner < 8; ++corner)
        result.add(pose({corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                         corner & 4 ? box.max.z : box.min.z}));
    return result;
}

}
