/// SIMD moving least squares on the tangent plane of a surfel.
#pragma once

#include "alcove/base/types.h"

#include <array>
#include <cstddef>
#include <vector>

namespace alcove {

/// The values of a surfel: ao, then the bent normal. Callers may use only the first.
using SurfelValues = std::array<float, 4>;

/// The evaluated surfels near a point, as arrays.
class FitSources {
  public:
    static constexpr std::size_t lanes = 16;

    void clear() { count_ = 0; }
    void push_back(const Surfel& surfel, const SurfelValues& values);

    struct Arrays {
        std::array<const float*, 3> position, normal;
        std::array<const float*, std::tuple_size_v<SurfelValues>> values;
        std::size_t count; ///< a multiple of `lanes`
    };
    /// Pads the arrays with sources that have no normal, and so no weight.
    Arrays arrays();

  private:
    static constexpr std::size_t first_value = 6, columns = first_value + std::tuple_size_v<SurfelValues>;
    std::array<std::vector<float>, columns> columns_; ///< position, normal, values
    std::size_t count_ = 0;
};

/// The fitted values at a point, and how well the sources agree with the fit.
struct LocalFit {
    float weight = 0.0f; ///< sum of the weights of the sources
    SurfelValues values{};
    float deviation = 0.0f; ///< weighted standard deviation of the first value from its linear fit
};

/// Fits the first `used` values of the sources as linear functions on the tangent plane (moving least squares:
/// Lancaster and Salkauskas 1981), with the weights
///
///     (1 − (|q|² + 2 (q·n)²)/reach²)₊²  (n_i·n)₊⁴,    q = p_i − p
///
/// which exclude the other side of a sheet and the other face of a crease. Cost: about 0.5 ns per source.
LocalFit local_fit(const FitSources::Arrays& sources, const Surfel& at, float reach, std::size_t used);

}
