/// Ridge regression of values on features.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace alcove {

struct RidgeRegression {
    /// The intercept, then the weight of each feature.
    std::vector<float> weights;

    /// Predicts values[i] from features[...][i], for i in [begin, end).
    void predict(std::span<const float* const> features, std::size_t begin, std::size_t end, float* values) const;
};

/// Regularised least squares over the first `count` values and features (Hoerl and Kennard 1970), so that correlated
/// terms share their weight. Uses a quarter of the values, but at least 4,096 (or all, if there are fewer) and at most
/// 16,384, in evenly spaced runs of 64. The result does not depend on the number of threads. Cost: about 10 ms for
/// forty features and 64,000 values or more.
RidgeRegression fit_linear_model(std::span<const float* const> features, std::span<const float> values,
                                 std::size_t count);

}
