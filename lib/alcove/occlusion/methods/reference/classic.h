/// Weighted probes along the normal, five by default.
#pragma once

#include "alcove/occlusion/detail/parameter.h"
#include "alcove/occlusion/methods/ring_bent_normal.h"

namespace alcove {

/// Each probe measures how much nearer the surface is than it would be over a plane:
///
///     ao = clamp(1 − k Σ w_i (h_i − d(p + h_i n))),   k = 3, w_i = 0.95^i, h_i = 0.01 + 0.12 i/4, i = 0..4
///
/// for a reference radius of 0.13. Other sample counts cover the same range of heights and weights, with the same sum
/// of weights. The reference formula stops once the sum exceeds 0.35; this is omitted, because outside solids the sum
/// never exceeds 0.303. The same probes behind the surface, with |d|, give an occlusion c of the inside; with o = 1 −
/// ao, convexity = ½ + ½ (c − o). The bent normal is that of ring_bent_normal(); it is not part of the reference.
///
/// Exact on planes (ao = 1, convexity = ½) and convex shapes (ao = 1). A solid thinner than two radii appears too
/// convex, because its far side is near: a plate of 0.1, 0.5, 1 or 2 radii has a convexity of 0.58, 0.77, 0.76 or 0.5.
/// Behind an open surface (Sign::sheet) the first voxel carries little information. Source: sdfao2026, after Evans
/// (2006). Cost: `samples` map() calls per surfel; twice that with convexity, 4 more with the bent normal.
struct Classic {
    float radius = 0.1f;   ///< maximum probe distance, > 0
    int samples = 5;       ///< >= 2
    float strength = 3.0f; ///< k, >= 0
    float falloff = 0.95f; ///< ratio of consecutive weights with five probes, in (0, 1]

    static constexpr std::string_view name = "classic";
    static constexpr std::string_view summary =
        "weighted probes along the normal, each measuring how much nearer the surface is than above a plane";
    static constexpr std::string_view formula =
        "clamp(1 - k sum w_i (h_i - d(p + h_i n))), k = 3, w_i = 0.95^i, h_i = 0.01 + 0.12 i/4, i = 0..4";
    static constexpr std::string_view source = "SDF Ambient Occlusion - Detailed Reference (2026)";
    static constexpr std::string_view cost =
        "5 map() calls (samples) per point; twice as many with convexity, 4 more with bent_normal";
    static constexpr std::string_view good =
        "fast and smooth; exact on planes and convex shapes; gives convexity and rough bent normals";
    static constexpr std::string_view bad =
        "sees only what is above the point: too dark in wide corners, blind to occluders at the side";
    static constexpr ChannelSet gives = Channel::ao | Channel::convexity | Channel::bent_normal;
    static constexpr float reference_radius = 0.13f;

    static constexpr auto parameters() {
        return std::array{
            parameter<&Classic::samples>("samples", 2, 1 << 20, "probes", "number of probes along the normal"),
            parameter<&Classic::strength>("strength", 0, 100, "", "k of the formula"),
            parameter<&Classic::falloff>("falloff", 0.01, 1, "", "ratio of consecutive weights with five probes"),
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
    /// The occlusion in [0, 1] on one side of the surface: `side` is 1 in front, −1 behind.
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
