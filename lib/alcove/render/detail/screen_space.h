/// Screen-space ambient occlusion: from depth and normals only, without map() calls beyond those of the image.
#pragma once

#include "alcove/occlusion/detail/parameter.h"
#include "alcove/render/camera.h"
#include "alcove/render/detail/depth_buffer.h"

#include <array>
#include <string_view>
#include <vector>

namespace alcove {

/// The filter that removes the noise of few samples.
enum class Blur {
    none,
    gaussian,  ///< exp(-s²/2σ²), for a distance s between pixels
    bilateral, ///< that times exp(-h²/2τ²) max(0, n·n')⁴, h the height of the other point above the tangent plane
};

/// For the point p with normal n that a pixel shows, in scene units:
///
///     1 - 1/N Σ [the pixel of q_i shows a point nearer to the eye than q_i, by less than the radius],
///     q_i = p + r_i·dir_i, dir_i·n > sin(bias)
///
/// over cosine-weighted directions, rotated per pixel to avoid banding, with jittered r_i = radius·√u. The square root
/// places more samples far out, where a sample is more likely to be behind an occluder. Each pixel is taken to show its
/// tangent plane, so that a plane does not occlude itself.
///
/// Source: lecture notes (aolecture) for the hemisphere kernel, range and angle checks, rotation and blur; Tomasi and
/// Manduchi (1998) for the bilateral weights, with τ a tenth of the radius. Thread-safe. Cost: N look-ups per pixel; a
/// blur adds four times its reach in pixels.
struct ScreenSpace {
    float radius = 0.1f;       ///< unit space, > 0
    int samples = 16;          ///< N
    float bias = 5.0f;         ///< samples within this angle of the tangent plane are excluded; degrees
    int blur = 2;              ///< a Blur
    float blur_reach = 0.125f; ///< relative to the projected radius; clamped to 1 to 64 pixels

    static constexpr std::string_view name = "screen_space";
    static constexpr std::string_view summary =
        "samples of the hemisphere, looked up in the depth and normals of the image";
    static constexpr std::string_view formula =
        "1 - 1/N sum [depth at the pixel of q_i < depth of q_i < that + radius], q_i = p + r_i dir_i";
    static constexpr std::string_view source = "04 Ambient Occlusion, lecture notes";
    static constexpr std::string_view cost = "no map() calls in addition to those of the image";
    static constexpr std::string_view good = "time depends on the number of pixels only";
    static constexpr std::string_view bad =
        "misses occluders that the camera does not see: outside the image or hidden";

    /// Depth, normal, position, and the occlusion before, between and after the two blur passes.
    static constexpr double bytes_per_pixel = sizeof(float) + 2 * sizeof(Vec3) + 3 * sizeof(float);

    static constexpr auto parameters() {
        return std::array{
            parameter<&ScreenSpace::samples>("samples", 1, 4096, "samples", "number of samples in the hemisphere"),
            parameter<&ScreenSpace::bias>("bias", 0.0, 60.0, "degrees",
                                          "directions closer than this to the tangent plane are excluded"),
            parameter<&ScreenSpace::blur>("blur", 0, 2, "", "0 none, 1 Gaussian, 2 bilateral"),
            parameter<&ScreenSpace::blur_reach>("blur_reach", 0.0, 1.0, "radii", "reach of the blur"),
        };
    }

    std::vector<float> operator()(const Renderable& renderable, const Camera& camera) const;

    /// From an existing depth buffer; `scene_radius` is in scene units.
    std::vector<float> operator()(const DepthBuffer& seen, double scene_radius) const;
};

}
