/// What an estimator is: a struct whose members are its parameters and whose call operator is the method.
///
///     struct Mine {
///         float radius = 0.1f;
///         template <Field F>
///         void operator()(const F& field, const SurfelBatch& surfels, const Outputs& out) const;
///     };
///
/// It writes a value a surfel to `out[Channel::ao]`, in [0, 1], and to the other channels it `gives` where
/// they are not null; every surfel of a batch has a normal. Lengths are in the unit of the field. `const` and
/// without state, so that any number of threads share one estimator. To be chosen by name it also says what it
/// is, as Classic does, and has its line in catalog.cpp.
///
/// *Document units*: the constants of a formula stand for the radius R₀ of its document. With R the wanted
/// radius, heights are multiplied by R/R₀ and distances by R₀/R, so that any uniform scale of scene and radius
/// gives the same values, and R = R₀ is the document itself.
#pragma once

#include "alcove/field/field.h"
#include "alcove/occlusion/channels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace alcove {

/// Up to `capacity` surfels as arrays, neighbours in space: what estimators work on at a time.
struct SurfelBatch {
    static constexpr std::size_t capacity = 64;
    using Values = std::array<float, capacity>;

    Values x, y, z;    ///< positions
    Values nx, ny, nz; ///< unit normals
    std::size_t count = 0;

    void push_back(const Surfel& surfel) {
        x[count] = surfel.position.x, y[count] = surfel.position.y, z[count] = surfel.position.z;
        nx[count] = surfel.normal.x, ny[count] = surfel.normal.y, nz[count] = surfel.normal.z;
        ++count;
    }
    Vec3 position(std::size_t i) const { return {x[i], y[i], z[i]}; }
    Vec3 normal(std::size_t i) const { return {nx[i], ny[i], nz[i]}; }
};

/// `F` is a Field, or a RaySurface for those that shoot rays at the mesh.
template <class E, class F>
concept Estimator = requires(const E& estimator, const F& field, const SurfelBatch& surfels,
                             const Outputs& out) {
    estimator(field, surfels, out);
};

/// The channels an estimator gives: those it names, else ao alone.
template <class E>
constexpr ChannelSet channels_of() {
    if constexpr (requires { E::gives; })
        return E::gives;
    else
        return Channel::ao;
}

/// A point a surfel.
struct ProbeBatch {
    SurfelBatch::Values x, y, z;

    void set(std::size_t i, const Vec3& p) { x[i] = p.x, y[i] = p.y, z[i] = p.z; }
};

/// distances[i] = map(probes[i]) for the first `count`; none is further than `reach` from the surface. Cost:
/// `count` map() calls.
template <Field F>
void map_probes(const F& field, const ProbeBatch& probes, std::size_t count, float reach, float* distances) {
    map_batch(field, Points{probes.x.data(), probes.y.data(), probes.z.data(), count}, reach, distances);
}

/// distances[i] = map(position + height · normal) for the whole batch; a negative height is behind the
/// surface. Cost: one map() a surfel.
template <Field F>
void probe_along_normal(const F& field, const SurfelBatch& surfels, float height, float* distances) {
    ProbeBatch probes;
    for (std::size_t i = 0; i < surfels.count; ++i) {
        probes.x[i] = surfels.x[i] + height * surfels.nx[i];
        probes.y[i] = surfels.y[i] + height * surfels.ny[i];
        probes.z[i] = surfels.z[i] + height * surfels.nz[i];
    }
    map_probes(field, probes, surfels.count, std::fabs(height), distances);
}

}
