/// What an estimator is: a struct whose members are its parameters and whose call operator is the method.
///
///     struct Mine {
///         float radius = 0.1f;
///         template <Field F>
///         void operator()(const F& field, const SurfelBatch& surfels, float* ao) const;
///     };
///
/// To be chosen by name at run time it also says what it is and takes its parameters from EstimatorOptions,
/// as Classic does, and has its line in catalog.cpp; `bake()` asks for neither.
///
/// It writes one visibility a surfel of the batch, in [0, 1]; every surfel of a batch has a normal. Lengths
/// are in the units of the field. `const` and without state, so that any number of threads share one
/// estimator.
#pragma once

#include "alcove/field/field.h"

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

/// What a user may set; an estimator takes what concerns it.
struct EstimatorOptions {
    float radius = 0.1f; ///< units of the field; may be infinite
    int samples = 0;     ///< probes a surfel; 0: the method's own
    int rays = 0;        ///< rays a surfel; 0: the method's own
    std::uint32_t seed = 0;
};

template <class E, class F>
concept Estimator = Field<F> &&
    requires(const E& estimator, const F& field, const SurfelBatch& surfels, float* ao) {
    estimator(field, surfels, ao);
};

/// distances[i] = map(position + height · normal) for the whole batch. Cost: one map() a surfel.
template <Field F>
void probe_along_normal(const F& field, const SurfelBatch& surfels, float height, float* distances) {
    SurfelBatch::Values x, y, z;
    for (std::size_t i = 0; i < surfels.count; ++i) {
        x[i] = surfels.x[i] + height * surfels.nx[i];
        y[i] = surfels.y[i] + height * surfels.ny[i];
        z[i] = surfels.z[i] + height * surfels.nz[i];
    }
    map_batch(field, Points{x.data(), y.data(), z.data(), surfels.count}, std::fabs(height), distances);
}

}
