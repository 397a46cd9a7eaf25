/// Probes along the normal, each with half the weight of the one before.
#pragma once

#include "alcove/occlusion/detail/parameter.h"
#include "alcove/occlusion/estimator.h"

namespace alcove {

///     ao = factor · (1 − Σ 2^(−h·s) (h − d(p + h n))),   h = 1/s, 2/s, ... < 1,   s = 5
///
/// for a reference radius of 1, clamped to [0, 1]. The sum starts above the surface, because a probe at height 0
/// carries no information. Assumes a unit normal. On a plane ao = factor. Source: geer. Cost: s − 1 map() calls
/// per surfel.
struct Exponential {
    float radius = 0.1f; ///< exclusive upper bound of the probe heights, > 0
    int samples = 5;     ///< s, >= 2
    float factor = 1.0f; ///< ao of an open plane, in [0, 1]

    static constexpr std::string_view name = "exponential";
    static constexpr std::string_view summary = "probes along the normal, each with half the weight of the one before";
    static constexpr std::string_view formula =
        "factor (1 - sum 2^(-h s) (h - d(p + h n))), h = 1/s, 2/s, ... < 1, s = 5";
    static constexpr std::string_view source = "G. Geer, Normally Sampled Ambient Occlusion";
    static constexpr std::string_view cost = "4 map() calls (samples - 1) per point";
    static constexpr std::string_view good = "fast and smooth; exact on planes and convex shapes";
    static constexpr std::string_view bad = "too bright: a closed crevice keeps two thirds of its light";
    static constexpr float reference_radius = 1.0f;

    static constexpr auto parameters() {
        return std::array{
            parameter<&Exponential::samples>("samples", 2, 1 << 20, "steps",
                                             "number of steps up to the radius; the last is not probed"),
            parameter<&Exponential::factor>("factor", 0, 1, "", "ao of an open plane"),
        };
    }

    template <Field F>
    void operator()(const F& field, const SurfelBatch& surfels, const Outputs& out) const {
        const float scale = radius / reference_radius;
        SurfelBatch::Values sum{}, distances;
        for (int i = 1; i < samples; ++i) {
            const float height = static_cast<float>(i) / static_cast<float>(samples);
            const float weight = std::exp2(static_cast<float>(-i));
            probe_along_normal(field, surfels, height * scale, distances.data());
            for (std::size_t k = 0; k < surfels.count; ++k)
                sum[k] += weight * (height - distances[k] / scale);
        }
        for (std::size_t k = 0; k < surfels.count; ++k)
            out[Channel::ao][k] = std::clamp(factor * (1.0f - sum[k]), 0.0f, 1.0f);
    }
};

}
