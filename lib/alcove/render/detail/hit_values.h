/// What is computed of all samples that meet the surface, before they are shaded.
#pragma once

#include "alcove/render/detail/camera_rays.h"
#include "alcove/render/renderer.h"

namespace alcove {

/// A value a sample; empty where no pass needs it.
struct HitValues {
    std::vector<float> ao, convexity, shadow;
};

/// `surroundings` is what occludes, the eye is in unit space.
HitValues values_of(const Hits& hits, const Renderable& renderable, const Occluders& surroundings,
                    const Vec3d& eye, const RenderOptions& options, const Progress& progress);

}
