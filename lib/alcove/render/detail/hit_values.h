/// Computes the channels of all samples that hit the surface, before shading.
#pragma once

#include "alcove/render/detail/camera_rays.h"
#include "alcove/render/renderer.h"

namespace alcove {

/// One value per sample; empty if no pass needs it.
struct HitValues {
    std::vector<float> ao, convexity, shadow;
};

/// Computes the values at all hits. `surroundings` are the occluders; `eye` is in unit space.
HitValues values_of(const Hits& hits, const Renderable& renderable, const Occluders& surroundings, const Vec3d& eye,
                    const RenderOptions& options, const Progress& progress);

}
