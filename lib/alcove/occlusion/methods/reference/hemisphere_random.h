/// Probes in random directions of the hemisphere, at distances that grow with the square of the probe index.
#pragma once

#include "alcove/occlusion/detail/parameter.h"
#include "alcove/occlusion/estimator.h"
#include "alcove/occlusion/methods/reference/hemisphere_frame.h"
#include "alcove/occlusion/methods/reference/reference_hash.h"

namespace alcove {

///     ao = clamp(1/n Σ clamp(5 d(p + h_i ω_i)/h_i, −1, 1)),   h_i = 0.01 + 4 (i/(n − 1))²,   i = 0..n − 1, n = 32
///
/// for a reference radius of 4.01; ω_i = (sin θ sin φ, sin θ cos φ, cos θ), (θ, φ) = hash2(seed + 13.1 i)·(3.14159,
/// 6.2831), flipped to the normal's side. The directions are the same for every surfel, in world axes or, with
/// `surfel_frame`, relative to its normal. On an open plane the reference states 0.75–0.99; over all seeds and planes
/// the range is 0.6–1, with a mean of 0.9. Source: sdfao2026. Cost: `samples` map() calls per surfel.
struct HemisphereRandom {
    float radius = 0.1f;       ///< maximum probe distance, > 0
    int samples = 32;          ///< n, >= 2
    bool surfel_frame = false; ///< directions rotate with the normal
    std::uint32_t seed = 0;

    static constexpr std::string_view name = "hemisphere_random";
    static constexpr std::string_view summary = "probes in random directions of the hemisphere, at growing distances";
    static constexpr std::string_view formula = "clamp(1/n sum clamp(5 d(p + h_i w_i)/h_i, -1, 1)), h_i = "
                                                "0.01 + 4 (i/(n-1))^2, i = 0..n-1, n = 32, w_i random";
    static constexpr std::string_view source = "SDF Ambient Occlusion - Detailed Reference (2026)";
    static constexpr std::string_view cost = "32 map() calls (samples) per point";
    static constexpr std::string_view good = "sees occluders at the side; fine creases and large shapes together";
    static constexpr std::string_view bad =
        "gives 0.6-1 instead of 1 on an open plane; patterns depend on the orientation of the scene";
    static constexpr float reference_radius = 4.01f;

    static constexpr auto parameters() {
        return std::array{
            parameter<&HemisphereRandom::samples>("samples", 2, 1 << 20, "probes",
                                                  "number of probes in the hemisphere"),
            parameter<&HemisphereRandom::surfel_frame>(
                "surfel_frame", 0, 1, "", "directions rotate with the normal instead of following world axes"),
            parameter<&HemisphereRandom::seed>("seed", 0, 0xffffffffu, "", "random seed of the directions"),
        };
    }

    template <Field F>
    void operator()(const F& field, const SurfelBatch& surfels, const Outputs& out) const {
        const float scale = radius / reference_radius;
        const HemisphereFrame frame(surfels, surfel_frame);
        SurfelBatch::Values sum{}, distances;
        ProbeBatch probes;
        for (int i = 0; i < samples; ++i) {
            const auto [u, v] = reference_hash2(seed + 13.1 * i);
            const double theta = u * 3.14159, phi = v * 6.2831, t = double(i) / (samples - 1);
            const Vec3 direction(std::sin(theta) * std::sin(phi), std::sin(theta) * std::cos(phi), std::cos(theta));
            const auto height = static_cast<float>(0.01 + 4.0 * t * t);
            for (std::size_t k = 0; k < surfels.count; ++k)
                probes.set(k, surfels.position(k) + height * scale * frame.flipped(k, direction));
            map_probes(field, probes, surfels.count, height * scale, distances.data());
            for (std::size_t k = 0; k < surfels.count; ++k)
                sum[k] += std::clamp(5.0f * distances[k] / (height * scale), -1.0f, 1.0f);
        }
        for (std::size_t k = 0; k < surfels.count; ++k)
            out[Channel::ao][k] = std::clamp(sum[k] / static_cast<float>(samples), 0.0f, 1.0f);
    }
};

}
