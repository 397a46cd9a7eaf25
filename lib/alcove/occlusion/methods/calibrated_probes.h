/// The probes of the calibrated estimator and the inputs of its networks, which fit/make_examples.cpp also uses to make
/// training examples.
#pragma once

#include "alcove/occlusion/detail/directions.h"
#include "alcove/occlusion/detail/ring_network.h"
#include "alcove/occlusion/estimator.h"

#include <limits>
#include <numbers>

namespace alcove {

struct CalibratedProbe {
    float height;      ///< distance from the surfel, in AO radii
    float tilt = 0.0f; ///< angle from the normal, degrees; 180: into the solid
    bool fine = false; ///< reads a level that is one finer than the height requires
};

/// Probes along the normal, and on rings around it with a probe at each azimuth.
struct ThirteenProbes {
    static constexpr std::array<CalibratedProbe, 5> normal{
        {{0.0442f}, {0.25f}, {0.707f}, {0.125f, 0.0f, true}, {0.03125f, 180.0f}}};
    static constexpr std::array<CalibratedProbe, 2> rings{{{0.354f, 45.0f}, {0.707f, 45.0f}}};
    static constexpr std::size_t azimuths = 4;
};
struct ThirtyEightProbes {
    static constexpr std::array<CalibratedProbe, 6> normal{
        {{0.03125f}, {0.0884f}, {0.25f}, {0.707f}, {0.125f, 0.0f, true}, {0.03125f, 180.0f}}};
    static constexpr std::array<CalibratedProbe, 4> rings{
        {{0.354f, 45.0f}, {0.707f, 45.0f}, {0.125f, 60.0f}, {1.0f, 60.0f}}};
    static constexpr std::size_t azimuths = 8;
};
struct SixtyThreeProbes {
    static constexpr std::array<CalibratedProbe, 7> normal{{{0.03125f},
                                                            {0.177f},
                                                            {1.0f},
                                                            {0.125f, 0.0f, true},
                                                            {0.5f, 0.0f, true},
                                                            {0.03125f, 180.0f},
                                                            {0.0625f, 180.0f}}};
    static constexpr std::array<CalibratedProbe, 7> rings{{{0.5f, 25.0f},
                                                           {0.707f, 60.0f},
                                                           {0.25f, 45.0f},
                                                           {0.0625f, 45.0f},
                                                           {0.25f, 75.0f},
                                                           {1.0f, 45.0f, true},
                                                           {0.0625f, 75.0f}}};
    static constexpr std::size_t azimuths = 8;
};

template <class Probes>
inline constexpr std::size_t probe_count = Probes::normal.size() + Probes::azimuths* Probes::rings.size();

/// One array over the batch per probe: those along the normal, then those at each azimuth.
template <class Probes>
using CalibratedInputs = std::array<SurfelBatch::Values, probe_count<Probes>>;

/// Network inputs other than the probes.
template <Field F>
RingNetwork::Condition calibrated_condition(const F& field, float radius) {
    constexpr float least = -0.25f, most = 1.25f; // radii of 4 to 256 voxels, as trained
    constexpr float typical = 0.42f;              // for analytic shapes: as for 10 % of D on the grid of a bake
    const float voxel = resolution(field);
    const float size = voxel > 0.0f ? std::log2(radius / voxel / 8.0f) / 4.0f : typical;
    return {std::clamp(size, least, most), two_sided(field) ? 1.0f : 0.0f};
}

/// The range of distances stored on the level that a probe reads, with the default bands of GridOptions. Inputs are
/// clamped to this range even if a grid has wider bands for other attributes, because the networks are trained with it.
struct KnownDistances {
    float least = -std::numeric_limits<float>::infinity(), most = std::numeric_limits<float>::infinity();

    KnownDistances(float finest_voxel, float reach) {
        constexpr float inner_band = 2.0f, outer_band = 5.0f; // voxels
        if (finest_voxel <= 0.0f)
            return;
        float voxel = finest_voxel;
        while ((outer_band - 1.0f) * voxel < reach)
            voxel *= 2.0f;
        least = -inner_band * voxel;
        most = outer_band * voxel;
    }
};

/// Computes the network inputs of a batch. For a probe at distance h, tilted by θ: x = cos θ − d/h, clamped to [−1,
/// 1.5]. x is 0 over a plane within the bands, negative over convex surfaces and positive near an occluder. It does not
/// depend on scale. Cost: one map() call per probe and surfel.
template <class Probes, Field F>
void calibrated_inputs(const F& field, const SurfelBatch& surfels, float radius, CalibratedInputs<Probes>& inputs) {
    ProbeBatch tangent, bitangent;
    for (std::size_t k = 0; k < surfels.count; ++k) {
        const Basis basis(surfels.normal(k));
        tangent.set(k, basis.tangent);
        bitangent.set(k, basis.bitangent);
    }
    const auto read = [&](const CalibratedProbe& probe, float azimuth, SurfelBatch::Values& input) {
        const float height = probe.height * radius, tilt = probe.tilt * std::numbers::pi_v<float> / 180.0f;
        const float phi = 2.0f * std::numbers::pi_v<float> * azimuth, cosine = std::cos(tilt);
        const float along = height * std::sin(tilt) * std::cos(phi), across = height * std::sin(tilt) * std::sin(phi);
        const float up = height * cosine;
        ProbeBatch points;
        for (std::size_t k = 0; k < surfels.count; ++k) {
            points.x[k] = surfels.x[k] + along * tangent.x[k] + across * bitangent.x[k] + up * surfels.nx[k];
            points.y[k] = surfels.y[k] + along * tangent.y[k] + across * bitangent.y[k] + up * surfels.ny[k];
            points.z[k] = surfels.z[k] + along * tangent.z[k] + across * bitangent.z[k] + up * surfels.nz[k];
        }
        SurfelBatch::Values distances;
        const float reach = probe.fine ? 0.5f * height : height;
        map_probes(field, points, surfels.count, reach, distances.data());
        const KnownDistances known(resolution(field), reach);
        const float per_height = 1.0f / height;
        for (std::size_t k = 0; k < surfels.count; ++k)
            input[k] = std::clamp(cosine - std::clamp(distances[k], known.least, known.most) * per_height, -1.0f, 1.5f);
    };
    std::size_t at = 0;
    for (const CalibratedProbe& probe : Probes::normal)
        read(probe, 0.0f, inputs[at++]);
    for (std::size_t a = 0; a < Probes::azimuths; ++a)
        for (const CalibratedProbe& probe : Probes::rings)
            read(probe, static_cast<float>(a) / static_cast<float>(Probes::azimuths), inputs[at++]);
}

}
