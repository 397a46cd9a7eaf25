/// SIMD weights and weighted sums for joint bilateral filtering and local regression.
#pragma once

#include <array>
#include <cstddef>

namespace alcove {

/// Surfels in the order of a curve, as arrays of at least `window` values.
struct Curve {
    static constexpr std::size_t window = 96; ///< consecutive surfels in one filter window
    static constexpr std::size_t probes = 10;

    const float *x, *y, *z;                 ///< positions
    const float *nx, *ny, *nz;              ///< unit normals, or zero to exclude a surfel
    std::array<const float*, probes> probe; ///< CalibratedInputs: those along the normal, then the mean of each ring
};

/// The weights of the `window` surfels from `first` on, as neighbours of surfel `center`: the products of
///
///     (1 − |p_i − p|²/reach²)₊²     (n_i·n)₊⁴     (1 − 0.4 Σ (probe_i − probe)²)₊²
void weigh(const Curve& curve, std::size_t center, std::size_t first, float reach, float* weights);

/// Weighted sums over a window, with the weights w, the guide g (relative to `origin`) and the values v: Σ w, Σ w g, Σ
/// w g², Σ w v, Σ w v g and Σ w v².
struct Moments {
    float w, g, gg;
    float v, vg, vv;
};
Moments moments(const float* weights, const float* guide, float origin, const float* values);

}
