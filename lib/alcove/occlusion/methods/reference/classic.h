/// Five probes along the normal, weighted.
#pragma once

#include "alcove/occlusion/detail/parameter.h"
#include "alcove/occlusion/methods/ring_bent_normal.h"

namespace alcove {

/// Each probe tells how much nearer the surface is than it would be over a plane:
///
///     ao = clamp(1 − k Σ w_i (h_i − d(p + h_i n))),   k = 3, w_i = 0.95^i, h_i = 0.01 + 0.12 i/4, i = 0..4
///
/// for a radius of 0.13. More or fewer samples spread over the same heights and weights, to the same sum of
/// weights. The document stops once the sum passes 0.35; that is left out, for outside of solids it never passes
/// 0.303. The same probes behind the surface, with |d|, give an
/// occlusion c of the inside beside o = 1 − ao: convexity = ½ + ½ (c − o). Source: "SDF Ambient Occlusion —
/// Detailed Reference" (2026), after A. Evans, "Fast approximations for global illumination on dynamic
/// scenes" (2006). Exact on planes (ao 1, convexity ½) and convex shapes (ao 1). Thinner than two radii a solid is
/// taken for more convex than it is, for its far side is near: a plate of 0.1, 0.5, 1 or 2 radii has a convexity of
/// 0.58, 0.77, 0.76 or 0.5. Behind an open surface (Sign::sheet) the first voxel tells little. The bent normal is that
/// of ring_bent_normal(), which no document has. Cost: `samples` map() calls a surfel, twice that with convexity,
/// 4 more with the bent normal.
struct Classic {
    float radius = 0.1f;   ///< furthest probe, > 0
    int samples = 5;       ///< >= 2
    float strength = 3.0f; ///< k, >= 0
    float falloff = 0.95f; ///< of the weights, from each of five probes to the next, in (0, 1]

    static constexpr std::string_view name = "classic";
    static constexpr std::string_view summary =
        "probes along the normal: how much nearer the surface is than over a plane, weighted";
    static constexpr std::string_view formula =
        "clamp(1 - k sum w_i (h_i - d(p + h_i n))), k = 3, w_i = 0.95^i, h_i = 0.01 + 0.12 i/4, i = 0..4";
    static constexpr std::string_view source = "SDF Ambient Occlusion - Detailed Reference (2026)";
    static constexpr std::string_view cost =
        "samples (5); twice that with convexity; 4 more with bent_normal";
    static constexpr std::string_view good =
        "quick and smooth; 1 on planes and convex shapes; gives convexity and rough bent normals";
    static constexpr std::string_view bad =
        "sees only what is above the point: too dark in wide corners, blind to what stands aside";
    static constexpr ChannelSet gives = Channel::ao | Channel::convexity | Channel::bent_normal;
    static constexpr float reference_radius = 0.13f;

    static constexpr auto parameters() {
        return std::array{
            parameter<&Classic::samples>("samples", 2, 1 << 20, "probes", "along the normal"),
            parameter<&Classic::strength>("strength", 0, 100, "", "k of the formula"),
            parameter<&Classic::falloff>("falloff", 0.01, 1, "", "of the weights, a fifth of the probes"),
        };
    }

    template <Field F>
    void operator()(const F& field, const SurfelBatch& surfels, const Outputs& out) const {
        SurfelBatch::Values outside, inside;
        probe(field, surfels, 1.0f, outside.data());
        for (std::size_t k = 0; k < surfels.count; ++k)
            out[Channel::ao][k] = 1.0f - outside[k];
        if (out[Channel::convexity]) {
            probe(field, surfels, -1.0f, inside.data());
            for (std::size_t k = 0; k < surfels.count; ++k)
                out[Channel::convexity][k] = 0.5f + 0.5f * (inside[k] - outside[k]);
        }
        if (out[Channel::bent_normal])
            ring_bent_normal(field, surfels, radius, out[Channel::ao], out[Channel::bent_normal]);
    }

  private:
    /// The occlusion, in [0, 1], on the given side of the surface: 1 in front, −1 behind.
    template <Field F>
    void probe(const F& field, const SurfelBatch& surfels, float side, float* occlusion) const {
        const float scale = radius / reference_radius;
        const float full = strength * sum_of_weights(5) / sum_of_weights(samples);
        SurfelBatch::Values sum{}, distances;
        for (int i = 0; i < samples; ++i) {
            const float t = static_cast<float>(i) / static_cast<float>(samples - 1);
            const float height = 0.01f + 0.12f * t, weight = std::pow(falloff, 4.0f * t);
            probe_along_normal(field, surfels, side * height * scale, distances.data());
            for (std::size_t k = 0; k < surfels.count; ++k) {
                const float d = side < 0.0f ? std::fabs(distances[k]) : distances[k];
                sum[k] += weight * (height - d / scale);
            }
        }
        for (std::size_t k = 0; k < surfels.count; ++k)
            occlusion[k] = std::clamp(full * sum[k], 0.0f, 1.0f);
    }

    float sum_of_weights(int count) const {
        float sum = 0.0f;
        for (int i = 0; i < count; ++i)
            sum += std::pow(falloff, 4.0f * static_cast<float>(i) / static_cast<float>(count - 1));
        return sum;
    }
};

}
