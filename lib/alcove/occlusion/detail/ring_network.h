/// A small neural network whose result does not depend on where a ring of inputs begins.
#pragma once

#include "alcove/occlusion/estimator.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace alcove {

/// The inputs are n (which concern the whole surfel), a condition c, and r_a at each azimuth a:
///
///     e_a = relu(W r_a + V (r_{a−1} + r_{a+1})/2 + U [n, c] + b),  f_a = relu(W₂ e_a + b₂)
///     h = relu(W₃ [mean f_a, n, c] + b₃),  N = w · h
///
/// with relu(x) = max(0, x) (Nair and Hinton 2010). The functions return results relative to those for n = 0 and r_a =
/// 0.
class RingNetwork {
  public:
    static constexpr std::size_t hidden = 32;    ///< size of h
    using LastLayer = std::array<float, hidden>; ///< w
    struct Condition {
        float resolution; ///< logarithm of the radius in voxels
        float two_sided;  ///< 1 for sheets, else 0
    };
    struct Shape {
        std::size_t shared, azimuths, features, first, second; ///< sizes of n, a, r_a, e_a and f_a
    };
    /// The number of coefficients.
    static std::size_t size(const Shape& shape);

    /// \param coefficients W, V, U, b, W₂, b₂, W₃, b₃ and w, row by row
    RingNetwork(const Shape& shape, std::vector<float> coefficients);
    RingNetwork(const RingNetwork&) = delete;
    RingNetwork& operator=(const RingNetwork&) = delete;

    using Hidden = std::array<SurfelBatch::Values, hidden>;
    /// h(x_i, c) − h(0, c) for all lanes of a batch; `inputs` are n, then r_a for each azimuth. Cost: 0.03 ns per
    /// coefficient and surfel with AVX2. The coefficients W, V and W₂ count once per azimuth.
    void hidden_layer(std::span<const SurfelBatch::Values> inputs, const Condition& condition, Hidden& h) const;
    /// values[i] = N(x_i, c) − N(0, c).
    static void value(const Hidden& h, const LastLayer& last, SurfelBatch::Values& values);

    const LastLayer& last_layer() const { return last_; }

  private:
    std::array<float, hidden> hidden_on_plane(const Condition& condition) const;

    Shape shape_;
    std::vector<float> coefficients_; // the pointers below point into it
    const float *own_, *neighbours_, *shared_, *first_bias_, *second_, *second_bias_, *third_, *third_bias_;
    LastLayer last_;
};

}
