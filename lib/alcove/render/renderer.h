/// Pictures of a field: camera rays, sphere-traced, shaded with ambient occlusion.
///
/// Every sample of every pixel that meets the surface becomes a surfel; the occlusion of all of them is baked
/// as that of vertices is, by the same estimators. Nothing depends on the number of threads.
#pragma once

#include "alcove/occlusion/catalog.h"
#include "alcove/render/camera.h"
#include "alcove/render/image.h"
#include "alcove/render/image_method.h"
#include "alcove/render/renderable.h"
#include "alcove/render/shading.h"
#include "alcove/render/soft_shadow.h"

namespace alcove {

/// Fewer probes for what is far away. Source: "SDF Ambient Occlusion — Detailed Reference" (2026), 5 to 2 over 50 units.
struct FewerSamples {
    int far_samples = 2;   ///< at `distance` and beyond, >= 1
    float distance = 0.0f; ///< from the eye, unit space, > 0
};

struct RenderOptions {
    /// Rays a pixel, >= 1, averaged; the same places in every pixel.
    int samples = 4;
    /// Estimator of occlusion; null: ao is 1 everywhere.
    const Method* method = nullptr;
    Settings settings{};
    /// Instead of the estimator, with the same settings.
    const ImageMethod* image_method = nullptr;
    /// Of a method that has a parameter `samples`, which is that of the settings at the eye.
    std::optional<FewerSamples> fewer{};
    Lighting lighting{};
    SoftShadow shadow{};              ///< of the key light
    bool casts_shadow = false;        ///< else it arrives everywhere, whatever the shadow pass shows
    PassSet passes = standard_passes; ///< what the image is to have; what none of them needs is not computed
};

/// A key light from the upper left in front of whatever the camera looks at, under a sky in direction `up`.
Lighting studio_lighting(const Camera& camera, const Vec3d& up);

/// The probes of a surfel at a distance from the eye: from `near_samples` to those of `fewer`, evenly.
int samples_at(float distance, int near_samples, const FewerSamples& fewer);

/// Draws in regions of a million samples, so memory stays that of the image and about 100 MB. All values are
/// finite. Cost: that of the rays (camera_rays.h), and the estimator's for each that meets the surface.
Image render(const Renderable& renderable, const Camera& camera, const RenderOptions& options,
             const Progress& progress = {});

}
