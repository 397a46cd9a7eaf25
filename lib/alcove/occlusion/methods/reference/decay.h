/// Distances along the normal relative to those above a plane.
#pragma once

#include "alcove/occlusion/detail/parameter.h"
#include "alcove/occlusion/estimator.h"

namespace alcove {

///     ao = Σ 2^(−i) d(p + h_i n) / Σ 2^(−i) h_i,   h_i = (i + 1) · radius/m,   i = 0..m − 1,   m = 5
///
/// or, in its linear form, Σ d / Σ h; clamped to [0, 1]. Exact (1) on planes and convex shapes. Source: Zucconi (2016),
/// where the linear form divides Σ d by the radius, so that it exceeds 1 in the open for m > 1. Cost: `samples` map()
/// calls per surfel.
struct Decay {
    float radius = 0.1f; ///< maximum probe distance, > 0
    int samples = 5;     ///< m, >= 1
    bool linear = false; ///< all probes have the same weight

    static constexpr std::string_view name = "decay";
    static constexpr std::string_view summary =
        "distances along the normal relative to those above a plane, with halving or equal weights";
    static constexpr std::string_view formula = "sum w_i d(p + h_i n) / sum w_i h_i, w_i = 2^-i (linear: 1), "
                                                "h_i = (i + 1) radius/m, i = 0..m-1, m = 5";
    static constexpr std::string_view source = "A. Zucconi, Volumetric Rendering: Ambient Occlusion";
    static constexpr std::string_view cost = "5 map() calls (samples) per point";
    static constexpr std::string_view good = "fast and smooth; exact on planes and convex shapes; no constant to tune";
    static constexpr std::string_view bad = "too bright in wide corners, blind to occluders at the side";

    static constexpr auto parameters() {
        return std::array{
            parameter<&Decay::samples>("samples", 1, 1 << 20, "probes", "number of probes along the normal"),
            parameter<&Decay::linear>("linear", 0, 1, "", "all probes have the same weight"),
        };
    }

    template <Field F>
    void operator()(const F& field, const SurfelBatch& surfels, const Outputs& out) const {
        SurfelBatch::Values sum{}, distances;
        float total = 0.0f;
        for (int i = 0; i < samples; ++i) {
            const float height = static_cast<float>(i + 1) * radius / static_cast<float>(samples);
            const float weight = linear ? 1.0f : std::exp2(static_cast<float>(-i));
            probe_along_normal(field, surfels, height, distances.data());
            total += weight * height;
            for (std::size_t k = 0; k < surfels.count; ++k)
                sum[k] += weight * distances[k];
        }
        for (std::size_t k = 0; k < surfels.count; ++k)
            out[Channel::ao][k] = std::clamp(sum[k] / total, 0.0f, 1.0f);
    }
};

}
