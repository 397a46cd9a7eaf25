/// The probes of the calibrated estimator and the inputs of its network. Also used by the program that fits it.
#pragma once

#include "alcove/occlusion/detail/directions.h"
#include "alcove/occlusion/estimator.h"

#include <numeric>

namespace alcove {

/// Probes evenly spaced on a circle around the normal.
struct ProbeRing {
    float height; ///< distance from the surfel, in AO radii
    float tilt;   ///< angle from the normal, degrees
    int count;
};

/// 10 probes: along the normal at 8^(−i/2) radii, and two rings of three.
struct TenProbes {
    static constexpr std::array heights{1.0f, 0.35355339f, 0.125f, 0.04419417f};
    static constexpr std::array<ProbeRing, 2> rings{{{0.7f, 45.0f, 3}, {0.35f, 60.0f, 3}}};
};

/// 24 probes: along the normal at 2^(−i) radii, and three rings of six.
struct TwentyFourProbes {
    static constexpr std::array heights{1.0f, 0.5f, 0.25f, 0.125f, 0.0625f, 0.03125f};
    static constexpr std::array<ProbeRing, 3> rings{{{1.0f, 60.0f, 6}, {0.5f, 60.0f, 6}, {0.25f, 60.0f, 6}}};
};

template <class Probes>
inline constexpr std::size_t
    probe_count = std::accumulate(Probes::rings.begin(), Probes::rings.end(), Probes::heights.size(),
                                  [](std::size_t sum, const ProbeRing& ring) { return sum + ring.count; });

/// One array over the batch per probe.
template <class Probes>
using CalibratedInputs = std::array<SurfelBatch::Values, probe_count<Probes>>;

/// The network input of a probe at distance h, tilted by θ: x = cos θ − d/h, clamped to [−1, 1.5]. 0 over a plane,
/// negative over convex surfaces, positive near an occluder; independent of scale and radius.
inline void probe_input(const SurfelBatch& surfels, const SurfelBatch::Values& distances, float height, float cosine,
                        SurfelBatch::Values& input) {
    const float per_height = 1.0f / height;
    for (std::size_t k = 0; k < surfels.count; ++k)
        input[k] = std::clamp(cosine - distances[k] * per_height, -1.0f, 1.5f);
}

/// Sorts each surfel's values in ascending order, so that the start angle of a ring matters little.
template <std::size_t inputs>
void sort_ring(const SurfelBatch& surfels, std::array<SurfelBatch::Values, inputs>& values, std::size_t begin,
               std::size_t end) {
    for (std::size_t last = end; last > begin + 1; --last)
        for (std::size_t i = begin; i + 1 < last; ++i)
            for (std::size_t k = 0; k < surfels.count; ++k) {
                const float a = values[i][k], b = values[i + 1][k];
                values[i][k] = std::min(a, b);
                values[i + 1][k] = std::max(a, b);
            }
}

/// Computes the network inputs of a batch. Cost: one map() call per input and surfel.
template <class Probes, Field F>
void calibrated_inputs(const F& field, const SurfelBatch& surfels, float radius, CalibratedInputs<Probes>& inputs) {
    SurfelBatch::Values distances;
    std::size_t at = 0;
    for (const float height : Probes::heights) {
        probe_along_normal(field, surfels, height * radius, distances.data());
        probe_input(surfels, distances, height * radius, 1.0f, inputs[at++]);
    }
    float turn = 0.0f; // every other ring is turned by half a step
    for (const ProbeRing& ring : Probes::rings) {
        const std::size_t begin = at;
        const float height = ring.height * radius, tilt = ring.tilt * std::numbers::pi_v<float> / 180.0f;
        const float sine = std::sin(tilt), cosine = std::cos(tilt);
        for (int i = 0; i < ring.count; ++i) {
            const float phi =
                2.0f * std::numbers::pi_v<float> * (static_cast<float>(i) + turn) / static_cast<float>(ring.count);
            const Vec3 direction(sine * std::cos(phi), sine * std::sin(phi), cosine);
            ProbeBatch probes;
            for (std::size_t k = 0; k < surfels.count; ++k)
                probes.set(k, surfels.position(k) + height * Basis(surfels.normal(k)).to_world(direction));
            map_probes(field, probes, surfels.count, height, distances.data());
            probe_input(surfels, distances, height, cosine, inputs[at++]);
        }
        sort_ring(surfels, inputs, begin, at);
        turn = 0.5f - turn;
    }
}

}
