/// nearest_covered() against a search of all texels.
#include "alcove/maps/detail/padding.h"

#include <gtest/gtest.h>

#include <random>

namespace alcove {
namespace {

TEST(Padding, FindsTheNearestCoveredTexelWithinTheMargin) {
    std::mt19937 random(1);
    for (const unsigned one_in : {2u, 30u, 400u})
        for (const int margin : {0, 1, 5, 1000}) {
            constexpr int width = 37, height = 23;
            std::vector<std::uint8_t> covered(width * height);
            for (std::uint8_t& c : covered)
                c = random() % one_in == 0;
            const std::vector<std::uint32_t> nearest = nearest_covered(covered, width, height, margin);
            const auto distance2 = [&](int a, int b) {
                const int dx = a % width - b % width, dy = a / width - b / width;
                return dx * dx + dy * dy;
            };
            for (int i = 0; i < width * height; ++i) {
                int least = 1 << 30;
                for (int k = 0; k < width * height; ++k)
                    if (covered[static_cast<std::size_t>(k)])
                        least = std::min(least, distance2(i, k));
                const auto found = static_cast<int>(nearest[static_cast<std::size_t>(i)]);
                if (least <= 2 * margin * margin) {
                    EXPECT_TRUE(covered[static_cast<std::size_t>(found)]);
                    EXPECT_EQ(distance2(i, found), least);
                } else {
                    EXPECT_EQ(found, i);
                }
            }
        }
}

}
}
