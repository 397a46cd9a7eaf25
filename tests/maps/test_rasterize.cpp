/// rasterize() against a test of every texel with every triangle.
#include "alcove/maps/detail/rasterize.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace alcove {
namespace {

glm::dvec2 centre_of(const UvTile& tile, std::size_t texel) {
    const auto width = static_cast<std::size_t>(tile.width);
    return {tile.corner.x + (static_cast<double>(texel % width) + 0.5) / tile.width,
            tile.corner.y + 1.0 - (static_cast<double>(texel / width) + 0.5) / tile.height};
}

double side(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
    return (b.x - a.x) * (p.y - a.y) - (p.x - a.x) * (b.y - a.y);
}

/// 1 inside, −1 outside, 0 within `rounding` of an edge.
int place(const UvTriangle& t, const glm::dvec2& p, double rounding) {
    const double area = side(t[0], t[1], glm::dvec2(t[2]));
    double least = 1e9;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec2 a(t[k]), b(t[(k + 1) % 3]);
        least = std::min(least, (area > 0 ? 1 : -1) * side(a, b, p) / glm::length(b - a));
    }
    return least > rounding ? 1 : least < -rounding ? -1 : 0;
}

UvTriangle random_triangle(std::mt19937& random, float spread) {
    std::uniform_real_distribution<float> coordinate(-0.2f, 1.2f), offset(-spread, spread);
    const Vec2 at(coordinate(random), coordinate(random));
    return {at, at + Vec2(offset(random), offset(random)), at + Vec2(offset(random), offset(random))};
}

TEST(Rasterize, TheFirstTriangleThatContainsACentreOwnsTheTexel) {
    std::mt19937 random(1);
    for (const float spread : {0.01f, 0.1f, 1.0f}) {
        std::vector<UvTriangle> triangles;
        for (int i = 0; i < 60; ++i)
            triangles.push_back(random_triangle(random, spread));
        const UvTile tile{67, 43};
        const TexelOwners owners = rasterize(triangles, tile);
        const double rounding = 1.0 / 256 / 43;
        std::size_t several = 0, unclear = 0;
        for (std::size_t i = 0; i < owners.size(); ++i) {
            std::size_t inside = 0, at_edges = 0;
            std::uint32_t first = no_triangle;
            for (std::uint32_t t = 0; t < triangles.size(); ++t) {
                const int where = place(triangles[t], centre_of(tile, i), rounding);
                inside += where > 0;
                at_edges += where == 0;
                if (where > 0 && first == no_triangle)
                    first = t;
            }
            several += inside > 1;
            unclear += at_edges > 0;
            if (at_edges == 0 && first != no_triangle) {
                EXPECT_EQ(owners.triangles[i], first) << i;
            }
        }
        EXPECT_NEAR(static_cast<double>(owners.overlaps), static_cast<double>(several), static_cast<double>(unclear));
    }
}

TEST(Rasterize, TexelsThatATriangleTouchesHaveAnOwner) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> weight(0.0, 1.0);
    for (int trial = 0; trial < 200; ++trial) {
        const UvTriangle t = random_triangle(random, trial % 2 == 0 ? 0.3f : 0.02f);
        const UvTile tile{50, 31};
        const TexelOwners owners = rasterize({&t, 1}, tile);
        for (int i = 0; i < 500; ++i) {
            double a = weight(random), b = weight(random);
            if (a + b > 1.0)
                a = 1.0 - a, b = 1.0 - b;
            const glm::dvec2 uv = a * glm::dvec2(t[0]) + b * glm::dvec2(t[1]) + (1.0 - a - b) * glm::dvec2(t[2]);
            if (uv.x <= 0.0 || uv.x >= 1.0 || uv.y <= 0.0 || uv.y >= 1.0)
                continue;
            const auto column = static_cast<std::size_t>(uv.x * tile.width),
                       row = static_cast<std::size_t>((1.0 - uv.y) * tile.height);
            EXPECT_EQ(owners.triangles[row * 50 + column], 0u);
        }
    }
}

// A fan around a point tiles its polygon exactly, whatever the rounding.
TEST(Rasterize, SharedEdgesNeitherOverlapNorLeaveGaps) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> coordinate(0.0f, 1.0f);
    for (int trial = 0; trial < 100; ++trial) {
        const Vec2 centre = trial == 0 ? Vec2(0.5f) : Vec2(coordinate(random), coordinate(random));
        const std::array<Vec2, 4> corners{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
        std::vector<UvTriangle> fan;
        for (std::size_t k = 0; k < 4; ++k)
            fan.push_back({corners[k], corners[(k + 1) % 4], centre});
        const TexelOwners owners = rasterize(fan, {64, 64});
        EXPECT_EQ(owners.overlaps, 0u);
        EXPECT_EQ(std::count(owners.triangles.begin(), owners.triangles.end(), no_triangle), 0);
    }
}

TEST(Rasterize, OverlapsCountOnceAndManyOfThemAreFast) {
    const std::vector<UvTriangle> triangles(20'000, {Vec2(0, 0), Vec2(2, 0), Vec2(0, 2)});
    const TexelOwners owners = rasterize(triangles, {1024, 1024});
    EXPECT_EQ(owners.overlaps, 1024u * 1024u);
    EXPECT_EQ(std::count(owners.triangles.begin(), owners.triangles.end(), 0u), 1024 * 1024);
}

TEST(Rasterize, OtherTilesBeginAtTheirCorner) {
    const UvTriangle t{Vec2(2, 1), Vec2(3, 1), Vec2(2, 2)};
    EXPECT_EQ(rasterize({&t, 1}, {8, 8}).triangles, std::vector<std::uint32_t>(64, no_triangle));
    const UvTriangle moved{Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)};
    EXPECT_EQ(rasterize({&t, 1}, {8, 8, Vec2(2, 1)}).triangles, rasterize({&moved, 1}, {8, 8}).triangles);
}

TEST(Rasterize, WeightsAreThoseOfTheNearestPoint) {
    std::mt19937 random(4);
    const UvTile tile{40, 20};
    for (int trial = 0; trial < 200; ++trial) {
        const UvTriangle t = random_triangle(random, 0.5f);
        const std::size_t texel = random() % 800;
        const Vec3d w = weights_at(t, tile, texel);
        EXPECT_NEAR(w.x + w.y + w.z, 1.0, 1e-12);
        const auto distance = [&](const Vec3d& weights) {
            const glm::dvec2 uv =
                weights.x * glm::dvec2(t[0]) + weights.y * glm::dvec2(t[1]) + weights.z * glm::dvec2(t[2]);
            return glm::length((uv - centre_of(tile, texel)) * glm::dvec2(40, 20)); // in texels
        };
        double nearest = 1e9;
        for (int i = 0; i <= 60; ++i)
            for (int k = 0; k + i <= 60; ++k)
                nearest = std::min(nearest, distance(Vec3d(i, k, 60 - i - k) / 60.0));
        EXPECT_LE(distance(w), nearest + 1e-9);
    }
}

}
}
