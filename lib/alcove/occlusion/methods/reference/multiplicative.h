/// Probes along the normal, each removing a share of the remaining light.
#pragma once

#include "alcove/occlusion/detail/parameter.h"
#include "alcove/occlusion/estimator.h"

namespace alcove {

///     ao = Π (1 − max(0, (h_i − d(p + h_i n)) · 0.2/h_i)),   h_i = (i + 1) · radius/6,   i = 0..5
///
/// The reference radius is 0.6. Exact (1) on planes and convex shapes. Source: sdfao2026. Cost: `samples` map()
/// calls per surfel.
struct Multiplicative {
    float radius = 0.1f;   ///< maximum probe distance, > 0
    int samples = 6;       ///< >= 1
    float strength = 0.2f; ///< share of the light that a probe with d = 0 removes, in [0, 1]

    static constexpr std::string_view name = "multiplicative";
    static constexpr std::string_view summary = "probes along the normal, each removing a share of the remaining light";
    static constexpr std::string_view formula =
        "product of 1 - max(0, (h_i - d(p + h_i n)) 0.2/h_i), h_i = 0.1 (i + 1), i = 0..5";
    static constexpr std::string_view source = "SDF Ambient Occlusion - Detailed Reference (2026)";
    static constexpr std::string_view cost = "6 map() calls (samples) per point";
    static constexpr std::string_view good = "fast and smooth; never fully black; exact on planes and convex shapes";
    static constexpr std::string_view bad = "too bright: a closed crevice keeps a quarter of its light";
    static constexpr float reference_radius = 0.6f;

    static constexpr auto parameters() {
        return std::array{
            parameter<&Multiplicative::samples>("samples", 1, 1 << 20, "probes", "number of probes along the normal"),
            parameter<&Multiplicative::strength>("strength", 0, 1, "",
                                                 "share of the light removed by a probe on the surface"),
        };
    }

    template <Field F>
    void operator()(const F& field, const SurfelBatch& surfels, const Outputs& out) const {
        SurfelBatch::Values distances;
        std::fill_n(out[Channel::ao], surfels.count, 1.0f);
        for (int i = 0; i < samples; ++i) {
            const float height = static_cast<float>(i + 1) * radius / static_cast<float>(samples);
            probe_along_normal(field, surfels, height, distances.data());
            for (std::size_t k = 0; k < surfels.count; ++k)
                out[Channel::ao][k] *= 1.0f - std::max(0.0f, (height - distances[k]) * strength / height);
        }
        for (std::size_t k = 0; k < surfels.count; ++k)
            out[Channel::ao][k] = std::clamp(out[Channel::ao][k], 0.0f, 1.0f);
    }
};

}
