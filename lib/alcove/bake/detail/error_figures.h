/// Error statistics of occlusion values.
#pragma once

#include <cstddef>
#include <span>

namespace alcove {

/// Statistics of the differences e_i = value_i − truth_i.
struct ErrorFigures {
    std::size_t count = 0;
    double rmse = 0.0;          ///< √(1/N Σ e²)
    double bias = 0.0;          ///< 1/N Σ e; above 0: too bright
    double percentile_99 = 0.0; ///< the smallest |e| that at least 99 % of all |e| do not exceed
    double max = 0.0;           ///< largest |e|
    double deviation = 0.0;     ///< standard deviation of the truth, which is the RMSE of its mean
};

/// All 0 if there are no values. \pre both have the same length.
ErrorFigures compare(std::span<const float> values, std::span<const float> truth);

}
