/// Probes in the directions of a Fibonacci sphere, at hashed distances.
#pragma once

#include "alcove/occlusion/detail/parameter.h"
#include "alcove/occlusion/estimator.h"
#include "alcove/occlusion/methods/reference/hemisphere_frame.h"
#include "alcove/occlusion/methods/reference/reference_hash.h"

#include <numbers>

namespace alcove {

///     ao = clamp(6/n Σ clamp(3 d(p + 0.01 n + 0.1 hash(i) ω_i))),   i = 0..n − 1, n = 32
///
/// for a reference radius of 0.11; ω_i = (cos φ sin θ, sin φ sin θ, z), φ = 2π fract(i/1.618…), z = cos θ = 1 − (2 i +
/// 1)/n, flipped to the normal's side. Every surfel uses the same directions, in world axes or, with `surfel_frame`,
/// relative to its normal. On an open plane, ao is 0.62–0.73. Source: sdfao2026. Cost: `samples` map() calls per
/// surfel.
struct Fibonacci {
    float radius = 0.1f;       ///< upper bound of the probe distances, > 0
    int samples = 32;          ///< n, >= 1
    bool surfel_frame = false; ///< directions rotate with the normal

    static constexpr std::string_view name = "fibonacci";
    static constexpr std::string_view summary = "probes in the directions of a Fibonacci sphere, at hashed distances";
    static constexpr std::string_view formula = "clamp(6/n sum clamp(3 d(p + 0.01 n + 0.1 hash(i) w_i))), "
                                                "w_i on a Fibonacci sphere, i = 0..n-1, n = 32";
    static constexpr std::string_view source = "SDF Ambient Occlusion - Detailed Reference (2026)";
    static constexpr std::string_view cost = "32 map() calls (samples) per point";
    static constexpr std::string_view good = "sees occluders at the side; evenly spread directions";
    static constexpr std::string_view bad = "gives 0.62-0.73 instead of 1 on an open plane: too dark everywhere; "
                                            "patterns depend on the orientation of the scene";
    static constexpr float reference_radius = 0.11f;

    static constexpr auto parameters() {
        return std::array{
            parameter<&Fibonacci::samples>("samples", 1, 1 << 20, "probes", "number of probes in the hemisphere"),
            parameter<&Fibonacci::surfel_frame>("surfel_frame", 0, 1, "",
                                                "directions rotate with the normal instead of following world axes"),
        };
    }

    template <Field F>
    void operator()(const F& field, const SurfelBatch& surfels, const Outputs& out) const {
        constexpr double golden_ratio = 1.618033988749895;
        const float scale = radius / reference_radius;
        const HemisphereFrame frame(surfels, surfel_frame);
        SurfelBatch::Values sum{}, distances;
        ProbeBatch probes;
        for (int i = 0; i < samples; ++i) {
            const double turns = i / golden_ratio;
            const double phi = 2.0 * std::numbers::pi * (turns - std::floor(turns));
            const double z = 1.0 - (2.0 * i + 1.0) / samples, across = std::sqrt(1.0 - z * z);
            const Vec3 direction(std::cos(phi) * across, std::sin(phi) * across, z);
            const auto length = static_cast<float>(0.1 * reference_hash(i));
            for (std::size_t k = 0; k < surfels.count; ++k)
                probes.set(k, surfels.position(k) +
                                  scale * (0.01f * surfels.normal(k) + length * frame.flipped(k, direction)));
            map_probes(field, probes, surfels.count, (0.01f + length) * scale, distances.data());
            for (std::size_t k = 0; k < surfels.count; ++k)
                sum[k] += std::clamp(3.0f * distances[k] / scale, 0.0f, 1.0f);
        }
        for (std::size_t k = 0; k < surfels.count; ++k)
            out[Channel::ao][k] = std::clamp(6.0f * sum[k] / static_cast<float>(samples), 0.0f, 1.0f);
    }
};

}
