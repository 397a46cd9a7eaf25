#include "alcove/occlusion/linear_model.h"

#include "alcove/occlusion/directions.h"

#include <gtest/gtest.h>

namespace alcove {
namespace {

std::vector<float> random_values(std::size_t count, std::uint32_t seed) {
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i)
        values[i] = unit_interval(hash(static_cast<std::uint32_t>(i) + hash(seed)));
    return values;
}

TEST(LinearModel, FindsTheCoefficientsBehindNoisyValues) {
    for (const std::size_t count : {500u, 100'000u}) { // all of them, and more than it looks at
        const std::vector<std::vector<float>> features{random_values(count, 1), random_values(count, 2)};
        const std::vector<float> noise = random_values(count, 3);
        std::vector<float> values(count);
        for (std::size_t i = 0; i < count; ++i)
            values[i] = 0.3f + 0.5f * features[0][i] - 0.2f * features[1][i] + 0.1f * (noise[i] - 0.5f);
        const LinearModel model = fit_linear_model(features, values, count);
        EXPECT_NEAR(model.constant, 0.3f, 0.01f);
        EXPECT_NEAR(model.weights[0], 0.5f, 0.01f);
        EXPECT_NEAR(model.weights[1], -0.2f, 0.01f);
        std::vector<float> predicted(count, -1.0f);
        model.predict(features, 1, count, predicted.data());
        EXPECT_EQ(predicted[0], -1.0f);
        EXPECT_NEAR(predicted[7], values[7] - 0.1f * (noise[7] - 0.5f), 0.02f);
    }
}

TEST(LinearModel, SharesTheWeightOfFeaturesThatTellTheSame) {
    const std::vector<float> feature = random_values(1000, 4);
    const LinearModel model = fit_linear_model(std::vector{feature, feature}, feature, 1000);
    EXPECT_NEAR(model.weights[0], 0.5f, 0.01f);
    EXPECT_NEAR(model.weights[1], 0.5f, 0.01f);
}

TEST(LinearModel, OfWhatIsTheSameEverywhereIsThat) {
    const std::vector<std::vector<float>> features{std::vector<float>(100, 0.25f)};
    const LinearModel model = fit_linear_model(features, std::vector<float>(100, 0.75f), 100);
    EXPECT_NEAR(model.constant + 0.25f * model.weights[0], 0.75f, 1e-5f);
}

}
}
