#include "alcove/render/detail/painted.h"

#include <gtest/gtest.h>

namespace alcove {
namespace {

const Camera from_above({0, 4, 0}, {0, 0, 0}, {0, 0, 1}, 90.0, {64, 64});

/// A square of side 4 in the plane y = height, with the values x/4 + z/8 + 1/2.
struct Square {
    std::vector<Vec3d> positions;
    std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
    std::vector<float> values;

    explicit Square(double height) : positions{{-2, height, -2}, {2, height, -2}, {2, height, 2}, {-2, height, 2}} {
        for (const Vec3d& p : positions)
            values.push_back(static_cast<float>(p.x / 4 + p.z / 8 + 0.5));
    }
};

TEST(Paint, InterpolatesLinearlyOverAPlane) {
    const Square square(0.0);
    const Image image = paint(square.positions, square.triangles, square.values, from_above, 1);
    int covered = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const auto i = static_cast<std::size_t>(64 * y + x);
            const Vec3d ray = from_above.direction(x + 0.5, y + 0.5);
            const Vec3d p = from_above.eye() - from_above.eye().y / ray.y * ray;
            const bool inside = std::fabs(p.x) < 1.99 && std::fabs(p.z) < 1.99;
            if (!inside) {
                if (std::fabs(p.x) > 2.01 || std::fabs(p.z) > 2.01) {
                    EXPECT_EQ(image.alpha[i], 0.0f);
                }
                continue;
            }
            ++covered;
            EXPECT_EQ(image.alpha[i], 1.0f) << "a hole at " << x << ", " << y;
            EXPECT_NEAR(image.ao[i], p.x / 4 + p.z / 8 + 0.5, 1e-5);
            EXPECT_NEAR(image.depth[i], 4.0, 1e-5);
            EXPECT_NEAR(image.normal[i].y, 1.0, 1e-6);
        }
    EXPECT_GT(covered, 900);
}

TEST(Paint, ShowsTheNearestOfTwoFacesWhicheverComesFirst) {
    const Square low(0.0), high(1.0);
    for (const bool high_first : {true, false}) {
        std::vector<Vec3d> positions = low.positions;
        positions.insert(positions.end(), high.positions.begin(), high.positions.end());
        std::vector<Triangle> triangles = low.triangles;
        for (const Triangle& t : high.triangles)
            triangles.insert(high_first ? triangles.begin() : triangles.end(), {t[0] + 4, t[1] + 4, t[2] + 4});
        const std::vector<float> values{0, 0, 0, 0, 1, 1, 1, 1};
        const Image image = paint(positions, triangles, values, from_above, 1);
        EXPECT_EQ(image.ao[64 * 32 + 32], 1.0f);
        EXPECT_NEAR(image.depth[64 * 32 + 32], 3.0, 1e-5);
    }
}

TEST(Paint, IsTheSameFromBehindAndAveragesSamples) {
    Square square(0.13);
    const Image front = paint(square.positions, square.triangles, square.values, from_above, 1);
    for (Triangle& t : square.triangles)
        std::swap(t[0], t[1]);
    EXPECT_EQ(paint(square.positions, square.triangles, square.values, from_above, 1).ao, front.ao);
    const Image fine = paint(square.positions, square.triangles, square.values, from_above, 4);
    int rim = 0;
    for (std::size_t i = 0; i < fine.pixels(); ++i) {
        rim += fine.alpha[i] > 0.0f && fine.alpha[i] < 1.0f;
        if (fine.alpha[i] == 1.0f && front.alpha[i] == 1.0f) {
            EXPECT_NEAR(fine.ao[i], front.ao[i], 1e-4);
        }
    }
    EXPECT_GT(rim, 50);
}

TEST(Paint, LeavesOutWhatHasNoAreaOrStandsBehindTheEye) {
    const std::vector<Vec3d> positions{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 5, 0}, {1, 5, 0}, {0, 5, 1}};
    const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}};
    const Image image = paint(positions, triangles, std::vector<float>(6, 1.0f), from_above, 1);
    EXPECT_EQ(image.alpha, std::vector<float>(64 * 64, 0.0f));
}

}
}
