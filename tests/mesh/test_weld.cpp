#include "alcove/mesh/detail/weld.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace alcove {
namespace {

TEST(Weld, NamesTheFirstVertexOfEachPlace) {
    std::mt19937 random(9);
    std::vector<Vec3d> positions{{0.0, -0.0, 0.0}, {-0.0, 0.0, 0.0}, {NAN, 0, 0}, {NAN, 0, 0}, {INFINITY, 1, 2}};
    for (int i = 0; i < 400; ++i)
        positions.push_back(1e-9 * Vec3d(random() % 5, random() % 5, random() % 5));
    const auto joined = weld(positions);
    ASSERT_EQ(joined.size(), positions.size());
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        std::uint32_t first = 0;
        while (first < v && !(positions[first] == positions[v]))
            ++first;
        EXPECT_EQ(joined[v], first) << "vertex " << v;
    }
    EXPECT_TRUE(weld({}).empty());
}

TEST(Weld, ManyVerticesThatEqualNoneStayLinear) {
    const std::vector<Vec3d> positions(500000, Vec3d(NAN));
    const auto joined = weld(positions);
    EXPECT_TRUE(std::is_sorted(joined.begin(), joined.end()));
    EXPECT_EQ(joined.back(), positions.size() - 1);
}

}
}
