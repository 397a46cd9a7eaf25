/// Probes along the normal at hashed heights, which are the same for every surfel.
#pragma once

#include "alcove/occlusion/detail/parameter.h"
#include "alcove/occlusion/estimator.h"
#include "alcove/occlusion/methods/reference/reference_hash.h"

namespace alcove {

///     ao = clamp(1 − 1/n Σ (l_i − d(p + l_i n))/(1 + l_i)),   l_i = (i + hash(i)) · 0.5/n · 4,   i = 1..n, n = 6
///
/// for a reference radius of 4 (source: sdfao2026). The falloff form is
///
///     ao = clamp(1 − 1/n Σ (l_i − max(d(p + l_i n), 0))/1 · falloff),   l_i = hash(i) · 1,   i = 0..n − 1
///
/// for a reference radius of 1 (source: hemisphericalao). Exact (1) on planes and convex shapes. Cost: `samples`
/// map() calls per surfel.
struct Jittered {
    float radius = 0.1f;       ///< upper bound of the probe distances, > 0
    int samples = 6;           ///< n, >= 1
    bool falloff_form = false; ///< use the second formula
    float falloff = 1.0f;      ///< factor of the second formula, >= 0

    static constexpr std::string_view name = "jittered";
    static constexpr std::string_view summary = "probes along the normal at hashed heights";
    static constexpr std::string_view formula =
        "clamp(1 - 1/n sum (l_i - d(p + l_i n))/(1 + l_i)), l_i = (i + hash(i)) 0.5/n 4, i = 1..n, n = 6; "
        "falloff form: clamp(1 - 1/n sum (l_i - max(d, 0)) falloff), l_i = hash(i), i = 0..n-1";
    static constexpr std::string_view source = "SDF Ambient Occlusion - Detailed Reference (2026); "
                                               "Hemispherical Signed Distance Field Ambient Occlusion";
    static constexpr std::string_view cost = "6 map() calls (samples) per point";
    static constexpr std::string_view good = "fast and smooth; exact on planes and convex shapes";
    static constexpr std::string_view bad = "too bright: a closed crevice keeps almost half of its light";

    static constexpr auto parameters() {
        return std::array{
            parameter<&Jittered::samples>("samples", 1, 1 << 20, "probes", "number of probes along the normal"),
            parameter<&Jittered::falloff_form>("falloff_form", 0, 1, "", "use the second formula"),
            parameter<&Jittered::falloff>("falloff", 0, 100, "", "factor of the second formula"),
        };
    }
    static constexpr float reference_radius = 4.0f, falloff_reference_radius = 1.0f;

    template <Field F>
    void operator()(const F& field, const SurfelBatch& surfels, const Outputs& out) const {
        const float form_radius = falloff_form ? falloff_reference_radius : reference_radius;
        const float scale = radius / form_radius;
        const int first = falloff_form ? 0 : 1;
        SurfelBatch::Values sum{}, distances;
        for (int i = first; i < first + samples; ++i) {
            const double jitter = reference_hash(i);
            const auto height = static_cast<float>(falloff_form ? jitter : (i + jitter) * 0.5 / samples * form_radius);
            probe_along_normal(field, surfels, height * scale, distances.data());
            for (std::size_t k = 0; k < surfels.count; ++k) {
                const float d = distances[k] / scale;
                sum[k] += falloff_form ? (height - std::max(d, 0.0f)) * falloff : (height - d) / (1.0f + height);
            }
        }
        for (std::size_t k = 0; k < surfels.count; ++k)
            out[Channel::ao][k] = std::clamp(1.0f - sum[k] / static_cast<float>(samples), 0.0f, 1.0f);
    }
};

}
