/// Pictures of a field: camera rays, sphere-traced, shaded with ambient occlusion.
///
/// Every sample of every pixel that meets the surface becomes a surfel; the occlusion of all of them is baked
/// as that of vertices is, by the same estimators. Nothing depends on the number of threads.
#pragma once

#include "alcove/occlusion/catalog.h"
#include "alcove/render/camera.h"
#include "alcove/render/image.h"
#include "alcove/render/shading.h"
#include "alcove/render/subject.h"

namespace alcove {

struct RenderOptions {
    /// Rays a pixel, >= 1, averaged; the same places in every pixel.
    int samples = 4;
    /// Estimator of occlusion; null: ao is 1 everywhere.
    const Method* method = nullptr;
    Settings settings{};
    Lighting lighting{};
};

/// A key light from the upper left in front of whatever the camera looks at, under a sky in direction `up`.
Lighting studio_lighting(const Camera& camera, const Vec3d& up);

/// Draws in regions of a million samples, so memory stays that of the image and about 100 MB. All values are
/// finite. Cost: that of the rays (camera_rays.h), and the estimator's for each that meets the surface.
Image render(const Subject& subject, const Camera& camera, const RenderOptions& options,
             const Progress& progress = {});

}
