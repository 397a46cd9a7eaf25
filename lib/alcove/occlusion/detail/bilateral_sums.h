/// The weighted sums behind a local regression, many neighbours at a time.
#pragma once

#include <array>
#include <cstddef>

namespace alcove {

/// Surfels along a curve, as arrays of at least `window` values.
struct Curve {
    static constexpr std::size_t window = 96; ///< neighbours on the curve that share their rays
    static constexpr std::size_t probes = 10;

    const float *x, *y, *z;
    const float *nx, *ny, *nz;              ///< unit, or zero for one without a say
    std::array<const float*, probes> probe; ///< what each of them tells
};

/// Weights of the `window` surfels from `first` on, as neighbours of surfel `center`: products of
///
///     (1 − |p_i − p|²/reach²)₊²     (n_i·n)₊⁴     (1 − 0.4 Σ (probe_i − probe)²)₊²
void weigh(const Curve& curve, std::size_t center, std::size_t first, float reach, float* weights);

/// Σ w, Σ w g, Σ w g²; Σ w v, Σ w v g, Σ w v², with g relative to `origin`.
struct Moments {
    float w, g, gg;
    float v, vg, vv;
};
Moments moments(const float* weights, const float* guide, float origin, const float* values);

}
