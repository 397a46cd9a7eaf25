/// Renders a field: sphere-traced camera rays, shaded with ambient occlusion.
///
/// Every sample that hits the surface becomes a surfel, and the estimators evaluate these surfels as they do the
/// vertices of a mesh. The result does not depend on the number of threads.
#pragma once

#include "alcove/occlusion/catalog.h"
#include "alcove/render/camera.h"
#include "alcove/render/image.h"
#include "alcove/render/renderable.h"
#include "alcove/render/shading.h"

namespace alcove {

struct ImageMethod; // an occlusion method for rendered images only (render/detail/image_method.h)

/// Fewer probes for distant surfels. Source: sdfao2026, which goes from 5 to 2 over 50 units.
struct FewerSamples {
    int far_samples = 2;   ///< samples at `distance` and beyond, >= 1
    float distance = 0.0f; ///< from the eye, unit space, > 0
};

struct RenderOptions {
    /// Rays per pixel, >= 1, averaged; at the same positions in every pixel.
    int samples = 4;
    /// Occlusion estimator; if null, ao is 1 everywhere.
    const Method* method = nullptr;
    Settings settings{};
    /// Replaces `method` if set, with the same settings.
    const ImageMethod* image_method = nullptr;
    /// For a method with a parameter `samples`: its value decreases from that of the settings at the eye.
    std::optional<FewerSamples> fewer{};
    Lighting lighting{};
    SoftShadow shadow{};              ///< of the key light
    bool casts_shadow = false;        ///< apply the shadow in the beauty pass; no effect on the shadow pass
    PassSet passes = standard_passes; ///< passes to render; values that none of them needs are not computed
};

/// A key light from the upper left, in front of the target of the camera, and a sky in direction `up`.
Lighting studio_lighting(const Camera& camera, const Vec3d& up);

/// The number of probes at `distance` from the eye (unit space), interpolated linearly between `near_samples` and
/// `fewer.far_samples`.
int samples_at(float distance, int near_samples, const FewerSamples& fewer);

/// Renders in regions of a million samples, so it needs the memory of the image plus about 100 MB. All values are
/// finite. Cost: that of the camera rays (detail/camera_rays.h) plus that of the estimator per sample that hits.
Image render(const Renderable& renderable, const Camera& camera, const RenderOptions& options,
             const Progress& progress = {});

}
