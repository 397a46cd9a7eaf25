/// The step count of camera rays as a stand-in for occlusion.
#pragma once

#include "alcove/occlusion/detail/parameter.h"
#include "alcove/render/camera.h"
#include "alcove/render/renderer.h"

#include <array>
#include <string_view>
#include <vector>

namespace alcove {

///     1 - steps/(max_steps - 1)
///
/// for the steps of plain sphere tracing, which stops at a distance of a twentieth of a voxel, but at least 1/5000 of
/// the diagonal (0.001 in the reference scene). Source: Zucconi (2016). Thread-safe. Cost: up to max_steps map() calls
/// per pixel, which a plain sphere tracer spends on the image anyway.
struct MarchSteps {
    float radius = 0.0f; ///< unused
    int max_steps = 128; ///< >= 2

    static constexpr std::string_view name = "march_steps";
    static constexpr std::string_view summary = "number of steps of the camera ray; it measures only cost";
    static constexpr std::string_view formula = "1 - steps/(max_steps - 1)";
    static constexpr std::string_view source = "A. Zucconi, Volumetric Rendering: Ambient Occlusion";
    static constexpr std::string_view cost = "no map() calls in addition to those of the image";
    static constexpr std::string_view good = "free; hints at creases and outlines";
    static constexpr std::string_view bad =
        "not occlusion: depends on the eye, and flat ground darkens toward the horizon";

    static constexpr double bytes_per_pixel = sizeof(float);

    static constexpr auto parameters() {
        return std::array{parameter<&MarchSteps::max_steps>("max_steps", 2, 4096, "steps",
                                                            "number of steps that makes a pixel black")};
    }

    std::vector<float> operator()(const Renderable& renderable, const Camera& camera) const;
};

}
