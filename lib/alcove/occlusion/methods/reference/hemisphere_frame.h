/// Maps a fixed set of directions, shared by all surfels, into the hemisphere around the normal of one surfel.
#pragma once

#include "alcove/occlusion/detail/directions.h"
#include "alcove/occlusion/estimator.h"

namespace alcove {

/// In world axes, as in the reference formulas, a direction below the surface is reversed. In the surfel's frame it
/// is mirrored into the upper half and rotates with the surface.
class HemisphereFrame {
  public:
    HemisphereFrame(const SurfelBatch& surfels, bool surfel_frame) : surfels_(surfels), surfel_frame_(surfel_frame) {}

    Vec3 flipped(std::size_t surfel, const Vec3& direction) const {
        const Vec3 normal = surfels_.normal(surfel);
        if (surfel_frame_)
            return Basis(normal).to_world({direction.x, direction.y, std::fabs(direction.z)});
        return glm::dot(direction, normal) < 0.0f ? -direction : direction;
    }

  private:
    const SurfelBatch& surfels_;
    bool surfel_frame_;
};

}
