/// A value that is linear in what is known of a surfel, fitted to many noisy ones.
#pragma once

#include <span>
#include <vector>

namespace alcove {

struct LinearModel {
    float constant = 0.0f;
    std::vector<float> weights; ///< of each feature

    /// values[i] = constant + Σ_k weights[k] · features[k][i] for i from `begin` to `end`.
    void predict(std::span<const std::vector<float>> features, std::size_t begin, std::size_t end,
                 float* values) const;
};

/// Least squares over the first `count` of the values and features, or 65,536 of them evenly in runs of 64,
/// regularised so that features that tell the same share their weight. A. Hoerl, R. Kennard, "Ridge regression:
/// biased estimation for nonorthogonal problems" (1970). The same whatever the number of threads. Cost: about
/// 20 ms.
LinearModel fit_linear_model(std::span<const std::vector<float>> features, std::span<const float> values,
                             std::size_t count);

}
