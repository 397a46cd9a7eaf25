#include "alcove/occlusion/detail/ring_network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace alcove {
namespace {

using Values = SurfelBatch::Values;

constexpr RingNetwork::Shape shape{3, 5, 2, 7, 6}; // no multiple of a SIMD block
constexpr RingNetwork::Condition condition{0.3f, 1.0f};

std::vector<float> random_numbers(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal(0.0f, 0.5f);
    std::vector<float> numbers(count);
    std::generate(numbers.begin(), numbers.end(), [&] { return normal(random); });
    return numbers;
}

std::vector<Values> random_inputs(unsigned seed) {
    std::vector<Values> inputs(shape.shared + shape.azimuths * shape.features);
    const std::vector<float> numbers = random_numbers(inputs.size() * SurfelBatch::capacity, seed);
    for (std::size_t i = 0; i < inputs.size(); ++i)
        std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(i * SurfelBatch::capacity), SurfelBatch::capacity,
                    inputs[i].begin());
    return inputs;
}

/// h for one surfel, from the formulas of RingNetwork in double precision; and N = w · h.
struct Reference {
    std::vector<double> hidden;
    double value;
};
Reference reference(const std::vector<float>& coefficients, const std::vector<double>& x) {
    std::vector<std::vector<double>> parts;
    std::size_t at = 0;
    const std::size_t whole = shape.shared + 2;
    for (const std::size_t size :
         {shape.first * shape.features, shape.first * shape.features, shape.first * whole, shape.first,
          shape.second * shape.first, shape.second, 32 * (shape.second + whole), std::size_t(32), std::size_t(32)}) {
        parts.emplace_back(coefficients.begin() + static_cast<std::ptrdiff_t>(at),
                           coefficients.begin() + static_cast<std::ptrdiff_t>(at + size));
        at += size;
    }
    EXPECT_EQ(at, coefficients.size());
    const auto product = [](const std::vector<double>& matrix, const std::vector<double>& v) {
        std::vector<double> result(matrix.size() / v.size(), 0.0);
        for (std::size_t row = 0; row < result.size(); ++row)
            for (std::size_t i = 0; i < v.size(); ++i)
                result[row] += matrix[row * v.size() + i] * v[i];
        return result;
    };
    const auto sum_of = [](std::initializer_list<std::vector<double>> all, bool rectified) {
        std::vector<double> sum(all.begin()->size(), 0.0);
        for (const auto& v : all)
            for (std::size_t i = 0; i < v.size(); ++i)
                sum[i] += v[i];
        for (double& s : sum)
            s = rectified ? std::max(s, 0.0) : s;
        return sum;
    };
    std::vector<double> given(x.begin(), x.begin() + shape.shared);
    given.insert(given.end(), {double(condition.resolution), double(condition.two_sided)});
    const auto ring = [&](std::size_t a, std::size_t i) {
        return x[shape.shared + a % shape.azimuths * shape.features + i];
    };
    std::vector<double> mean(shape.second, 0.0);
    for (std::size_t a = 0; a < shape.azimuths; ++a) {
        std::vector<double> own, middle;
        for (std::size_t i = 0; i < shape.features; ++i) {
            own.push_back(ring(a, i));
            middle.push_back(0.5 * (ring(a + shape.azimuths - 1, i) + ring(a + 1, i)));
        }
        const std::vector<double> e =
            sum_of({product(parts[0], own), product(parts[1], middle), product(parts[2], given), parts[3]}, true);
        const std::vector<double> f = sum_of({product(parts[4], e), parts[5]}, true);
        for (std::size_t i = 0; i < mean.size(); ++i)
            mean[i] += f[i] / shape.azimuths;
    }
    mean.insert(mean.end(), given.begin(), given.end());
    Reference result{sum_of({product(parts[6], mean), parts[7]}, true), 0.0};
    for (std::size_t i = 0; i < 32; ++i)
        result.value += parts[8][i] * result.hidden[i];
    return result;
}

TEST(RingNetwork, ComputesItsFormulas) {
    const std::vector<float> coefficients = random_numbers(RingNetwork::size(shape), 1);
    const RingNetwork network(shape, coefficients);
    const std::vector<Values> inputs = random_inputs(2);
    Values values;
    RingNetwork::Hidden hidden;
    network.hidden_layer(inputs, condition, hidden);
    RingNetwork::value(hidden, network.last_layer(), values);
    const Reference plane = reference(coefficients, std::vector<double>(inputs.size(), 0.0));
    for (std::size_t k = 0; k < SurfelBatch::capacity; ++k) {
        std::vector<double> x;
        for (const Values& input : inputs)
            x.push_back(input[k]);
        const Reference expected = reference(coefficients, x);
        EXPECT_NEAR(values[k], expected.value - plane.value, 1e-4) << k;
        for (std::size_t i = 0; i < hidden.size(); ++i)
            EXPECT_NEAR(hidden[i][k], expected.hidden[i] - plane.hidden[i], 1e-4) << i;
    }
}

TEST(RingNetwork, DoesNotDependOnWhereTheRingBegins) {
    const std::vector<float> coefficients = random_numbers(RingNetwork::size(shape), 3);
    const RingNetwork network(shape, coefficients);
    std::vector<Values> inputs = random_inputs(4);
    const auto value = [&] {
        RingNetwork::Hidden hidden;
        Values values;
        network.hidden_layer(inputs, condition, hidden);
        RingNetwork::value(hidden, network.last_layer(), values);
        return values;
    };
    const Values before = value();
    std::rotate(inputs.begin() + shape.shared, inputs.begin() + shape.shared + 2 * shape.features, inputs.end());
    const Values after = value();
    for (std::size_t k = 0; k < SurfelBatch::capacity; ++k)
        EXPECT_NEAR(before[k], after[k], 1e-5);
}

TEST(RingNetwork, IsZeroForInputsOfZero) {
    const std::vector<float> coefficients = random_numbers(RingNetwork::size(shape), 5);
    std::vector<Values> inputs(shape.shared + shape.azimuths * shape.features);
    for (Values& input : inputs)
        input.fill(0.0f);
    for (const RingNetwork::Condition& c : {condition, RingNetwork::Condition{-0.25f, 0.0f}}) {
        RingNetwork::Hidden hidden;
        RingNetwork(shape, coefficients).hidden_layer(inputs, c, hidden);
        for (const Values& values : hidden)
            for (const float value : values)
                EXPECT_NEAR(value, 0.0f, 1e-5f);
    }
}

}
}
