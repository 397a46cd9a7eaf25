/// A small feed-forward network, evaluated for a batch of surfels.
#pragma once

#include "alcove/occlusion/estimator.h"

namespace alcove {

/// outputs = weights · inputs + bias.
template <std::size_t inputs, std::size_t outputs>
struct NetworkLayer {
    std::array<std::array<float, inputs>, outputs> weights;
    std::array<float, outputs> bias;

    /// Computes all lanes of the batch, including unused ones: lanes are independent.
    void apply(const std::array<SurfelBatch::Values, inputs>& in, std::array<SurfelBatch::Values, outputs>& out) const {
        for (std::size_t o = 0; o < outputs; ++o) {
            SurfelBatch::Values sum;
            sum.fill(bias[o]);
            for (std::size_t i = 0; i < inputs; ++i)
                for (std::size_t k = 0; k < SurfelBatch::capacity; ++k)
                    sum[k] += weights[o][i] * in[i][k];
            out[o] = sum;
        }
    }
};

/// Two hidden layers of rectified linear units, max(0, x) (Nair and Hinton 2010), and a linear output.
template <std::size_t inputs, std::size_t first_units, std::size_t second_units>
struct Network {
    NetworkLayer<inputs, first_units> first;
    NetworkLayer<first_units, second_units> second;
    NetworkLayer<second_units, 1> last;

    SurfelBatch::Values operator()(const std::array<SurfelBatch::Values, inputs>& in) const {
        std::array<SurfelBatch::Values, first_units> a;
        std::array<SurfelBatch::Values, second_units> b;
        std::array<SurfelBatch::Values, 1> value;
        first.apply(in, a);
        rectify(a);
        second.apply(a, b);
        rectify(b);
        last.apply(b, value);
        return value[0];
    }

  private:
    template <std::size_t units>
    static void rectify(std::array<SurfelBatch::Values, units>& values) {
        for (SurfelBatch::Values& unit : values)
            for (float& value : unit)
                value = std::max(value, 0.0f);
    }
};

}
