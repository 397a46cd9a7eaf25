/// Occlusion methods that give one value per pixel of a rendered image, so that the values depend on the camera.
#pragma once

#include "alcove/occlusion/catalog.h"
#include "alcove/render/camera.h"
#include "alcove/render/renderer.h"

#include <span>

namespace alcove {

/// A type-erased image method with its description.
struct ImageMethod : MethodInfo {
    double bytes_per_pixel; ///< working memory
    /// Visibility at the centre of every pixel, in [0, 1], row by row from the top left. Background pixels may have
    /// any value.
    std::vector<float> (*occlusion)(const Renderable& renderable, const Camera& camera, const Settings& settings);
};

std::span<const ImageMethod> image_methods();

/// The image method called `name`, or null.
const ImageMethod* find_image_method(std::string_view name);

}
