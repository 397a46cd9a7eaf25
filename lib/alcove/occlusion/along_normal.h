/// Estimators that probe the field along the surface normal.
#pragma once

#include "alcove/occlusion/estimator.h"

namespace alcove {

/// Five probes along the normal, each telling how much nearer the surface is than it would be over a plane:
///
///     ao = clamp(1 − 3 Σ 0.95^i (h_i − d(p + h_i n))),   h_i = 0.01 + 0.12 i/4,   i = 0..4
///
/// for a radius of 0.13; other radii by scaling the scene. Source: "SDF Ambient Occlusion — Detailed
/// Reference" (2026), after A. Evans, "Fast approximations for global illumination on dynamic scenes" (2006).
/// Exact on planes and convex shapes (1). Cost: `samples` map() calls a surfel.
struct Classic {
    float radius = 0.1f; ///< furthest probe, > 0
    int samples = 5;     ///< probes, >= 2, at heights and weights spread over those of the five

    static constexpr std::string_view name = "classic";
    static constexpr std::string_view summary =
        "probes along the normal, weighted sum of what is nearer than over a plane";
    static constexpr std::string_view formula = "clamp(1 - 3 sum 0.95^i (h_i - d(p + h_i n))), i = 0..4";
    static constexpr std::string_view source = "SDF Ambient Occlusion - Detailed Reference (2026)";
    static constexpr std::string_view cost = "samples (5)";
    static constexpr float document_radius = 0.13f;

    static Classic from(const EstimatorOptions& options) {
        // In unit space nothing is further than the diagonal.
        Classic classic{.radius = std::min(options.radius, 1.0f)};
        if (options.samples > 0)
            classic.samples = std::max(options.samples, 2);
        return classic;
    }

    template <Field F>
    void operator()(const F& field, const SurfelBatch& surfels, float* ao) const {
        const float scale = radius / document_radius;
        constexpr float sum_of_five =
            1.0f + 0.95f + 0.95f * 0.95f + 0.95f * 0.95f * 0.95f + 0.95f * 0.95f * 0.95f * 0.95f;
        SurfelBatch::Values occlusion{}, distances;
        float sum_of_weights = 0.0f;
        for (int i = 0; i < samples; ++i) {
            const float t = static_cast<float>(i) / static_cast<float>(samples - 1);
            const float height = 0.01f + 0.12f * t, weight = std::pow(0.95f, 4.0f * t);
            sum_of_weights += weight;
            probe_along_normal(field, surfels, height * scale, distances.data());
            for (std::size_t k = 0; k < surfels.count; ++k)
                occlusion[k] += weight * (height - distances[k] / scale);
        }
        const float strength = 3.0f * sum_of_five / sum_of_weights;
        for (std::size_t k = 0; k < surfels.count; ++k)
            ao[k] = std::clamp(1.0f - strength * occlusion[k], 0.0f, 1.0f);
    }
};

}
