/// A value by what is known of a surfel and by products of that, fitted to many noisy ones.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace alcove {

struct RidgeRegression {
    /// Of 1; then of each feature and its products with those up to itself.
    std::vector<float> weights;

    /// values[i] by the features of i, for i from `begin` to `end`.
    void predict(std::span<const float* const> features, std::size_t begin, std::size_t end,
                 float* values) const;
};

/// Least squares over the first `count` of the values and features: over a quarter of them, but 4,096 to 16,384, evenly
/// in runs of 64, regularised so that terms that tell the same share their weight. A. Hoerl, R. Kennard, "Ridge
/// regression: biased estimation for nonorthogonal problems" (1970). The same whatever the number of threads. Cost:
/// about 10 ms for eleven features and 64,000 values or more.
RidgeRegression fit_quadratic_model(std::span<const float* const> features, std::span<const float> values,
                                    std::size_t count);

}
