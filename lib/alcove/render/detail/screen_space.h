/// Occlusion from what the camera sees: depth and normals, no map() beyond those of the picture.
#pragma once

#include "alcove/occlusion/detail/parameter.h"
#include "alcove/render/camera.h"
#include "alcove/render/detail/depth_buffer.h"

#include <array>
#include <string_view>
#include <vector>

namespace alcove {

/// What smooths the noise of few samples.
enum class Blur {
    none,
    gaussian, ///< exp(-s²/2σ²) of the distance s between pixels
    bilateral, ///< times exp(-h²/2τ²) of the height h of one place above the other's tangent plane, and max(0, n·n')⁴
};

/// Of each pixel's place p with normal n, in scene units:
///
///     1 - 1/N Σ [a place nearer to the eye than q_i, by less than the radius, is seen at the pixel of q_i],
///     q_i = p + r_i·dir_i, dir_i·n > sin(bias)
///
/// over cosine-weighted directions turned for each pixel against banding, r_i = radius·√u jittered: more of them far out,
/// where a sample is behind what hides it. What is seen is taken for the tangent plane of its pixel, so that a plane does
/// not hide itself. Source: "04 Ambient Occlusion", lecture notes: hemisphere kernel, range and angle checks, rotation,
/// blur; bilateral weights: C. Tomasi and R. Manduchi, "Bilateral filtering for gray and color images" (1998), with τ a tenth
/// of the radius. Thread-safe. Cost: N look-ups a pixel, and four times the reach for a blur.
struct ScreenSpace {
    float radius = 0.1f;       ///< unit space, > 0
    int samples = 16;          ///< N
    float bias = 5.0f;         ///< degrees above the tangent plane
    int blur = 2;              ///< a Blur
    float blur_reach = 0.125f; ///< of the radius as it is seen, from 1 to 64 pixels

    static constexpr std::string_view name = "screen_space";
    static constexpr std::string_view summary =
        "samples of the hemisphere, looked up in depth and normals of the picture";
    static constexpr std::string_view formula =
        "1 - 1/N sum [depth at the pixel of q_i < depth of q_i < that + radius], q_i = p + r_i dir_i";
    static constexpr std::string_view source = "04 Ambient Occlusion, lecture notes";
    static constexpr std::string_view cost = "0 beside those of the picture";
    static constexpr std::string_view good = "time depends on the pixels alone";
    static constexpr std::string_view bad =
        "blind to what is not seen, outside the image or behind what is in front";

    /// A depth, a normal, a place, and the occlusion before, between and after its blurs.
    static constexpr double bytes_per_pixel = sizeof(float) + 2 * sizeof(Vec3) + 3 * sizeof(float);

    static constexpr auto parameters() {
        return std::array{
            parameter<&ScreenSpace::samples>("samples", 1, 4096, "samples", "of the hemisphere"),
            parameter<&ScreenSpace::bias>("bias", 0.0, 60.0, "degrees", "above the tangent plane, left out"),
            parameter<&ScreenSpace::blur>("blur", 0, 2, "", "0 none, 1 Gaussian, 2 bilateral"),
            parameter<&ScreenSpace::blur_reach>("blur_reach", 0.0, 1.0, "radii", "that the blur reaches"),
        };
    }

    std::vector<float> operator()(const Renderable& renderable, const Camera& camera) const;

    /// From what is seen already; `scene_radius` is in scene units.
    std::vector<float> operator()(const DepthBuffer& seen, double scene_radius) const;
};

}
