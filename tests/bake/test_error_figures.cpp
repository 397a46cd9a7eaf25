#include "alcove/bake/detail/error_figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace alcove {
namespace {

TEST(ErrorFigures, AreThoseOfHandMadeValues) {
    const std::vector<float> truth{0.0f, 0.5f, 1.0f, 0.5f};
    const std::vector<float> values{0.25f, 0.5f, 0.5f, 0.75f}; // off by 1/4, 0, -1/2, 1/4
    const ErrorFigures figures = compare(values, truth);
    EXPECT_EQ(figures.count, 4u);
    EXPECT_DOUBLE_EQ(figures.rmse, std::sqrt(0.375 / 4.0));
    EXPECT_DOUBLE_EQ(figures.bias, 0.0);
    EXPECT_DOUBLE_EQ(figures.max, 0.5);
    EXPECT_DOUBLE_EQ(figures.percentile_99, 0.5);
    EXPECT_DOUBLE_EQ(figures.deviation, std::sqrt(0.125));
    EXPECT_DOUBLE_EQ(compare({}, {}).rmse, 0.0);
}

TEST(ErrorFigures, SayWhatMostDifferencesStayBelow) {
    // 1/1000, ..., 200/1000 in shuffled order: 198 of 200 are 0.198 or less.
    std::vector<float> truth(200, 0.0f), values(200);
    for (std::size_t i = 0; i < 200; ++i)
        values[i * 77 % 200] = -static_cast<float>(i + 1) / 1000.0f;
    const ErrorFigures figures = compare(values, truth);
    EXPECT_FLOAT_EQ(static_cast<float>(figures.percentile_99), 0.198f);
    EXPECT_FLOAT_EQ(static_cast<float>(figures.max), 0.2f);
    EXPECT_NEAR(figures.bias, -0.1005, 1e-7);
}

TEST(ErrorFigures, OfTheBestConstantAreTheDeviationOfTheTruth) {
    std::vector<float> truth;
    for (int i = 0; i < 32; ++i)
        truth.push_back(static_cast<float>(i * i % 64) / 64.0f);
    const float mean =
        std::accumulate(truth.begin(), truth.end(), 0.0f) / 32.0f; // exact: all values are multiples of 1/64
    const ErrorFigures figures = compare(std::vector<float>(32, mean), truth);
    EXPECT_NEAR(figures.rmse, figures.deviation, 1e-12);
    EXPECT_NEAR(figures.bias, 0.0, 1e-12);
    EXPECT_GT(figures.deviation, 0.1);
}

}
}
