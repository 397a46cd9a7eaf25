/// Nested placements combined, in double precision.
#pragma once

#include "alcove/field/primitives.h"
#include "alcove/scene/scene.h"

#include <glm/mat3x3.hpp>

namespace alcove {

/// p' = rotation · (scale · p) + translation.
struct Pose {
    glm::dmat3 rotation{1.0}; ///< orthonormal
    double scale = 1.0;
    Vec3d translation{0.0};

    Vec3d operator()(const Vec3d& p) const { return rotation * (scale * p) + translation; }
};

Pose pose_of(const Placement& placement);

/// Applies the inner pose first, then the outer.
Pose operator*(const Pose& outer, const Pose& inner);

/// The axis-aligned box around the posed box.
Box posed(const Box& box, const Pose& pose);

/// Transforms a field from the unit space of `own`, a frame in the space of a shape, to the unit space of the scene.
template <Field F>
AnyField posed(F field, const Frame& own, const Pose& pose, const Frame& scene) {
    return Transformed<F>{std::move(field), glm::mat3(pose.rotation),
                          static_cast<float>(pose.scale * own.diagonal / scene.diagonal),
                          scene.to_unit(pose(own.center))};
}

}
