/// How far occlusion values are from the truth, in a few numbers.
#pragma once

#include <cstddef>
#include <span>

namespace alcove {

/// Of the differences e_i = value_i − truth_i.
struct ErrorFigures {
    std::size_t count = 0;
    double rmse = 0.0;          ///< √(1/N Σ e²)
    double bias = 0.0;          ///< 1/N Σ e: above 0 is too open
    double percentile_99 = 0.0; ///< the least |e| that 99 % of all do not exceed
    double max = 0.0;           ///< largest |e|
    double deviation = 0.0;     ///< standard deviation of the truth: the RMSE of the best constant guess
};

/// All 0 where there is nothing to compare. \pre both are as long.
ErrorFigures compare(std::span<const float> values, std::span<const float> truth);

}
