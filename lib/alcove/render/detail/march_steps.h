/// The number of steps that a ray of the eye takes, as if it were occlusion.
#pragma once

#include "alcove/occlusion/detail/parameter.h"
#include "alcove/render/camera.h"
#include "alcove/render/renderable.h"

#include <array>
#include <string_view>
#include <vector>

namespace alcove {

///     1 - steps/(max_steps - 1)
///
/// of plain sphere tracing to a twentieth of a voxel, or for exact fields to 1/5000 of the diagonal, which is 0.001 in the
/// scene of the documents. Source: A. Zucconi, "Volumetric Rendering: Ambient Occlusion". Thread-safe. Cost: up to
/// max_steps map() calls a pixel, which would trace the picture as well.
struct MarchSteps {
    float radius = 0.0f; ///< has no meaning here
    int max_steps = 128; ///< >= 2

    static constexpr std::string_view name = "march_steps";
    static constexpr std::string_view summary = "steps of the ray of the eye: nothing but its cost";
    static constexpr std::string_view formula = "1 - steps/(max_steps - 1)";
    static constexpr std::string_view source = "A. Zucconi, Volumetric Rendering: Ambient Occlusion";
    static constexpr std::string_view cost = "0 beside those of the picture";
    static constexpr std::string_view good = "for nothing; hints at creases and outlines";
    static constexpr std::string_view bad =
        "no occlusion: depends on the eye, and flat ground darkens toward the horizon";

    static constexpr double bytes_per_pixel = sizeof(float);

    static constexpr auto parameters() {
        return std::array{
            parameter<&MarchSteps::max_steps>("max_steps", 2, 4096, "steps", "where it is black")};
    }

    std::vector<float> operator()(const Renderable& renderable, const Camera& camera) const;
};

}
