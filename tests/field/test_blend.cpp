#include "alcove/field/detail/blend.h"
#include "alcove/field/field.h"
#include "alcove/field/primitives.h"

#include <gtest/gtest.h>

#include <random>

namespace alcove {
namespace {

const Sphere ball{{0.2f, -0.1f, 0.3f}, 0.7f};
const Cuboid block{{-0.3f, 0.2f, 0.1f}, {0.5f, 0.3f, 0.8f}};
const Plane floor_plane{{0, 1, 0}, 0.0f};

std::vector<Vec3> random_points(int count) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> coordinate(-2.0f, 2.0f);
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i)
        points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
    return points;
}

TEST(SmoothMin, IsTheFormulaOfItsSource) {
    // Quilez 2013: h = max(k - |a - b|, 0)/k; min(a, b) - h² k/4.
    for (const double k : {0.1, 1.0, 3.0})
        for (double a = -2.0; a <= 2.0; a += 0.37)
            for (double b = -2.0; b <= 2.0; b += 0.41) {
                const double h = std::fmax(k - std::fabs(a - b), 0.0) / k;
                EXPECT_NEAR(smooth_min(static_cast<float>(a), static_cast<float>(b), static_cast<float>(k)),
                            std::fmin(a, b) - h * h * k / 4.0, 1e-6);
            }
}

TEST(SmoothMin, WithoutWidthIsTheLesser) {
    const float infinite = any_reach;
    EXPECT_EQ(smooth_min(1.0f, -2.0f, 0.0f), -2.0f);
    EXPECT_EQ(smooth_min(0.5f, 0.5f, 0.0f), 0.5f);
    EXPECT_EQ(smooth_min(infinite, infinite, 0.3f), infinite);
    EXPECT_EQ(smooth_min(infinite, 1.0f, 0.3f), 1.0f);
}

TEST(Blend, WithoutWidthIsTheSharpSet) {
    const BlendedUnion<AnyField> both({ball, block}, 0.0f);
    const Difference<AnyField> cut({ball, block}, 0.0f);
    for (const Vec3& p : random_points(500)) {
        EXPECT_EQ(both.map(p), std::min(ball.map(p), block.map(p)));
        EXPECT_EQ(cut.map(p), std::max(ball.map(p), -block.map(p)));
        EXPECT_EQ(cut.map(p) < 0.0f, ball.map(p) < 0.0f && block.map(p) > 0.0f);
    }
}

TEST(Blend, BatchedFormsEqualScalarOnes) {
    const std::vector<Vec3> points = random_points(600);
    std::vector<float> x, y, z, distances(points.size());
    for (const Vec3& p : points)
        x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
    const BlendedUnion<AnyField> both({ball, block, floor_plane}, 0.4f);
    const Difference<AnyField> cut({ball, block, floor_plane}, 0.4f);
    for (const AnyField& field : {AnyField(both), AnyField(cut)}) {
        field.map({x.data(), y.data(), z.data(), x.size()}, any_reach, distances.data());
        for (std::size_t i = 0; i < points.size(); ++i)
            EXPECT_EQ(distances[i], field.map(points[i]));
    }
}

/// The Lipschitz constant is 1, so a value never exceeds the distance to the zero set.
TEST(Blend, NeverPromisesMoreThanTheWay) {
    const std::vector<Vec3> points = random_points(400);
    const BlendedUnion<AnyField> both({ball, block, floor_plane}, 0.5f);
    const Difference<AnyField> cut({block, ball, Plane{{0, 1, 0}, -0.05f}}, 0.5f);
    for (const AnyField& field : {AnyField(both), AnyField(cut)})
        for (std::size_t i = 1; i < points.size(); ++i) {
            const float distance = glm::length(points[i] - points[i - 1]);
            EXPECT_LE(std::fabs(field.map(points[i]) - field.map(points[i - 1])), distance + 1e-5f);
        }
}

TEST(Blend, FillsACornerUpToItsWidth) {
    const Plane wall{{1, 0, 0}, 0.0f};
    const BlendedUnion<AnyField> corner({floor_plane, wall}, 0.2f);
    EXPECT_NEAR(corner.map({0.0f, 0.0f, 0.0f}), -0.05f, 1e-7f);
    EXPECT_NEAR(corner.map({0.2f, 0.0f, 0.0f}), 0.0f, 1e-7f);
    EXPECT_NEAR(corner.map({0.5f, 0.1f, 0.0f}), 0.1f, 1e-7f);
    EXPECT_NEAR(corner.map({0.05f, 0.05f, 0.0f}), 0.0f, 1e-7f);
}

}
}
