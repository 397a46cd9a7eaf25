/// Methods of occlusion that make sense in pictures alone: a value a pixel, of the camera's own.
#pragma once

#include "alcove/occlusion/catalog.h"
#include "alcove/render/camera.h"
#include "alcove/render/renderable.h"

#include <span>

namespace alcove {

/// A method behind a function pointer, as its struct describes itself.
struct ImageMethod : MethodInfo {
    double bytes_per_pixel; ///< of memory while it works
    /// Visibility of every pixel at its centre, row after row from the top left, in [0, 1]; anything where nothing is
    /// seen.
    std::vector<float> (*occlusion)(const Renderable& renderable, const Camera& camera,
                                    const Settings& settings);
};

std::span<const ImageMethod> image_methods();

/// The method of that name, or null.
const ImageMethod* find_image_method(std::string_view name);

}
