#include "alcove/occlusion/detail/ridge_regression.h"

#include "alcove/occlusion/detail/directions.h"

#include <gtest/gtest.h>

namespace alcove {
namespace {

std::vector<float> random_values(std::size_t count, std::uint32_t seed) {
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i)
        values[i] = 2.0f * unit_interval(hash(static_cast<std::uint32_t>(i) + hash(seed))) - 1.0f;
    return values;
}

TEST(RidgeRegression, FindsTheFunctionBehindNoisyValues) {
    for (const std::size_t count : {900u, 100'000u}) { // fewer and more than the fit uses
        const std::vector<float> a = random_values(count, 1), b = random_values(count, 2),
                                 noise = random_values(count, 3);
        const auto truth = [&](std::size_t i) { return 0.3f + 0.5f * a[i] - 0.2f * b[i]; };
        std::vector<float> values(count);
        for (std::size_t i = 0; i < count; ++i)
            values[i] = truth(i) + 0.05f * noise[i];
        const std::array<const float*, 2> features{a.data(), b.data()};
        const RidgeRegression model = fit_linear_model(features, values, count);
        std::vector<float> predicted(count, -1.0f);
        model.predict(features, 1, count, predicted.data());
        EXPECT_EQ(predicted[0], -1.0f);
        for (const std::size_t i : {std::size_t{1}, std::size_t{70}, count - 1})
            EXPECT_NEAR(predicted[i], truth(i), 0.02f) << i;
    }
}

TEST(RidgeRegression, SharesTheWeightOfFeaturesThatTellTheSame) {
    const std::vector<float> feature = random_values(1000, 4);
    const std::array<const float*, 2> features{feature.data(), feature.data()};
    const RidgeRegression model = fit_linear_model(features, feature, 1000);
    ASSERT_EQ(model.weights.size(), 3u);
    EXPECT_NEAR(model.weights[1], 0.5f, 0.01f);
    EXPECT_NEAR(model.weights[2], 0.5f, 0.01f);
}

TEST(RidgeRegression, OfWhatIsTheSameEverywhereIsThat) {
    const std::vector<float> feature(100, 0.25f);
    const std::array<const float*, 1> features{feature.data()};
    std::vector<float> predicted(100);
    fit_linear_model(features, std::vector<float>(100, 0.75f), 100).predict(features, 0, 100, predicted.data());
    for (const float value : predicted)
        EXPECT_NEAR(value, 0.75f, 1e-5f);
}

}
}
