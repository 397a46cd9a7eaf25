/// Probes in random directions bent toward the normal, to reduce self-occlusion.
#pragma once

#include "alcove/occlusion/detail/parameter.h"
#include "alcove/occlusion/estimator.h"
#include "alcove/occlusion/methods/reference/hemisphere_frame.h"
#include "alcove/occlusion/methods/reference/reference_hash.h"

#include <numbers>

namespace alcove {

///     ao = clamp(1 − 1/n Σ (l_i − max(d(p + l_i ω_i), 0)) · falloff),   l_i = hash(i),   i = 0..n − 1, n = 32
///
/// for a reference radius of 1; ω_i = normalize(n + (1 − 1/n) v_i), v_i = (cos s, sin s, t)/√(1 + t²) flipped to the
/// normal's side, s = 2π hash(l_i + 1), t = 2 hash(l_i + 2) − 1. With fewer samples the directions bend more toward the
/// normal. The directions are the same for every surfel, in world axes or, with `surfel_frame`, relative to its normal.
/// On an open plane, ao is 0.90–0.95. Source: hemisphericalao, after Evans (2006), Quilez (2008) and Hart (1996). Cost:
/// `samples` map() calls per surfel.
struct Hemisphere {
    float radius = 0.1f;       ///< upper bound of the probe distances, > 0
    int samples = 32;          ///< n, >= 1; 16 are usable
    float falloff = 1.0f;      ///< strength of the occlusion, >= 0
    bool surfel_frame = false; ///< directions rotate with the normal

    static constexpr std::string_view name = "hemisphere";
    static constexpr std::string_view summary = "probes in random directions bent toward the normal";
    static constexpr std::string_view formula = "clamp(1 - 1/n sum (l_i - max(d(p + l_i w_i), 0)) falloff), "
                                                "l_i = hash(i), w_i = normalize(n + (1 - 1/n) v_i), "
                                                "v_i random, i = 0..n-1, n = 32";
    static constexpr std::string_view source = "Hemispherical Signed Distance Field Ambient Occlusion";
    static constexpr std::string_view cost = "32 map() calls (samples) per point";
    static constexpr std::string_view good = "sees occluders at the side; little self-occlusion";
    static constexpr std::string_view bad =
        "gives 0.90-0.95 instead of 1 on an open plane; low contrast; patterns depend on the orientation of the scene";
    static constexpr float reference_radius = 1.0f;

    static constexpr auto parameters() {
        return std::array{
            parameter<&Hemisphere::samples>("samples", 1, 1 << 20, "probes", "number of probes in the hemisphere"),
            parameter<&Hemisphere::falloff>("falloff", 0, 100, "", "strength of the occlusion"),
            parameter<&Hemisphere::surfel_frame>("surfel_frame", 0, 1, "",
                                                 "directions rotate with the normal instead of following world axes"),
        };
    }

    template <Field F>
    void operator()(const F& field, const SurfelBatch& surfels, const Outputs& out) const {
        const float scale = radius / reference_radius;
        const float lean = 1.0f - 1.0f / static_cast<float>(samples);
        const HemisphereFrame frame(surfels, surfel_frame);
        SurfelBatch::Values sum{}, distances;
        ProbeBatch probes;
        for (int i = 0; i < samples; ++i) {
            const double length = reference_hash(i);
            const double s = 2.0 * std::numbers::pi * reference_hash(length + 1.0);
            const double t = 2.0 * reference_hash(length + 2.0) - 1.0;
            const Vec3 direction(Vec3d(std::cos(s), std::sin(s), t) / std::sqrt(1.0 + t * t));
            const auto height = static_cast<float>(length);
            for (std::size_t k = 0; k < surfels.count; ++k) {
                const Vec3 leaning = glm::normalize(surfels.normal(k) + lean * frame.flipped(k, direction));
                probes.set(k, surfels.position(k) + height * scale * leaning);
            }
            map_probes(field, probes, surfels.count, height * scale, distances.data());
            for (std::size_t k = 0; k < surfels.count; ++k)
                sum[k] += (height - std::max(distances[k] / scale, 0.0f)) * falloff;
        }
        for (std::size_t k = 0; k < surfels.count; ++k)
            out[Channel::ao][k] = std::clamp(1.0f - sum[k] / static_cast<float>(samples), 0.0f, 1.0f);
    }
};

}
