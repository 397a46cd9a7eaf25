/// resample(): means and interpolation by hand.
#include "alcove/maps/detail/resample.h"

#include <gtest/gtest.h>

namespace alcove {
namespace {

void expect_near(const std::vector<float>& values, const std::vector<float>& expected) {
    ASSERT_EQ(values.size(), expected.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_NEAR(values[i], expected[i], 1e-6f) << i;
}

TEST(Resample, SmallerTexelsAreMeansOverTheirArea) {
    expect_near(resample(std::vector<float>{1, 3, 5, 7, 2, 4, 6, 8}, 1, {4, 2}, {2, 1}), {2.5f, 6.5f});
    // The middle texel of three belongs to both halves.
    expect_near(resample(std::vector<float>{0, 3, 9}, 1, {3, 1}, {2, 1}), {1.0f, 7.0f});
    expect_near(resample(std::vector<float>{0, 3, 9}, 1, {1, 3}, {1, 2}), {1.0f, 7.0f});
}

TEST(Resample, LargerTexelsAreInterpolated) {
    expect_near(resample(std::vector<float>{0, 4}, 1, {2, 1}, {4, 1}), {0, 1, 3, 4});
    expect_near(resample(std::vector<float>{0, 4}, 1, {1, 2}, {1, 4}), {0, 1, 3, 4});
    expect_near(resample(std::vector<float>{5}, 1, {1, 1}, {3, 2}), {5, 5, 5, 5, 5, 5});
}

TEST(Resample, ChannelsStayApart) {
    expect_near(resample(std::vector<float>{0, 10, 4, 30}, 2, {2, 1}, {1, 1}), {2, 20});
    expect_near(resample(std::vector<float>{0, 10, 4, 30}, 2, {2, 1}, {2, 1}), {0, 10, 4, 30});
}

}
}
