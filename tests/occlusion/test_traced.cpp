/// traced against closed forms on exact fields: cosine-weighted visibility is a configuration factor of a
/// disc, a sphere cap or a half plane (Howell 1982).
#include "alcove/occlusion/methods/traced.h"

#include "alcove/field/primitives.h"
#include "alcove/occlusion/estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace alcove {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr double pi = std::numbers::pi;
const float radii[] = {0.3f, 1.0f, 2.5f, infinite};

template <class F>
double traced(const F& field, const Vec3& p, float radius, bool cosine_weighted = true) {
    const std::vector<Surfel> surfels{{p, {0, 1, 0}}};
    return evaluate_ao(surfels, field, Traced{.radius = radius, .rays = 4096, .cosine_weighted = cosine_weighted})
        .front();
}

TEST(Traced, FloorBesideAnInfiniteWall) {
    const Union field(Plane{}, Plane{{1, 0, 0}, 0.0f});
    for (const float x : {0.05f, 0.2f, 0.5f, 0.9f})
        for (const float radius : radii) {
            const double u = std::min(1.0, double(x) / radius);
            const double expected = 1.0 - (std::acos(u) - u * std::sqrt(1.0 - u * u)) / pi;
            EXPECT_NEAR(traced(field, {x, 0, 0}, radius), expected, 0.01) << x << " " << radius;
            EXPECT_NEAR(traced(field, {x, 0, 0}, radius, false), expected, 0.01) << x << " " << radius;
        }
}

TEST(Traced, FloorBesideAWallOfSomeHeight) {
    for (const float height : {0.5f, 1.0f, 3.0f}) {
        const Union field(Plane{}, Cuboid{{-500.0f, 0.0f, 0.0f}, {500.0f, height, 1e4f}});
        for (const float x : {0.1f, 0.5f, 2.0f}) {
            const double expected = 0.5 * (1.0 + x / std::hypot(x, height));
            EXPECT_NEAR(traced(field, {x, 0, 0}, infinite), expected, 0.01) << x << " " << height;
        }
    }
}

TEST(Traced, FloorUnderASphere) {
    for (const float a : {0.5f, 1.0f})
        for (const float h : {1.05f, 1.5f, 2.5f})
            for (const float s : {0.0f, 0.8f, 2.0f})
                for (const float radius : radii) {
                    const Union field(Plane{}, Sphere{{s, h, 0}, a});
                    const double d2 = double(h) * h + double(s) * s, d = std::sqrt(d2), a2 = double(a) * a, r = radius;
                    double share = 1.0 - std::pow((r * r + d2 - a2) / (2 * r * d), 2);
                    if (r >= std::sqrt(d2 - a2))
                        share = a2 / d2;
                    else if (r <= d - a)
                        share = 0.0;
                    EXPECT_NEAR(traced(field, {0, 0, 0}, radius), 1.0 - share * h / d, 0.01)
                        << a << " " << h << " " << s << " " << radius;
                }
}

/// A round pit of radius a and depth `depth` in the ground, with its floor at y = 0. Distances in the air are exact.
struct Pit {
    float a, depth;

    float map(const Vec3& p) const {
        const float across = std::hypot(p.x, p.z);
        if (p.y < depth)
            return std::min(p.y, a - across);
        return across < a ? std::min(p.y, std::hypot(p.y - depth, a - across)) : p.y - depth;
    }
};

TEST(Traced, FloorOfAPit) {
    for (const float a : {0.3f, 1.0f})
        for (const float depth : {0.2f, 1.0f, 2.0f})
            for (const float radius : radii) {
                const double a2 = double(a) * a, r = radius;
                const double expected = std::min(1.0, std::max(a2 / (a2 + double(depth) * depth), a2 / (r * r)));
                EXPECT_NEAR(traced(Pit{a, depth}, {0, 0, 0}, radius), expected, 0.01) << a << " " << depth << " " << r;
            }
}

/// Air inside a sphere, solid outside.
struct Cavity {
    float a;
    float map(const Vec3& p) const { return a - glm::length(p); }
};

TEST(Traced, InsideASphere) {
    for (const float a : {0.5f, 1.0f})
        for (const float radius : radii) {
            const double expected = 1.0 - std::pow(std::min(1.0, double(radius) / (2.0 * a)), 2);
            EXPECT_NEAR(traced(Cavity{a}, {0, -a, 0}, radius), expected, 0.01) << a << " " << radius;
        }
}

TEST(Traced, OpenOnPlanesAndConvexShapes) {
    EXPECT_EQ(traced(Plane{}, {0, 0, 0}, infinite), 1.0);
    EXPECT_NEAR(traced(Plane{}, {0, 0, 0}, 0.5f, false), 1.0, 0.001);
    EXPECT_EQ(traced(Sphere{}, {0, 1, 0}, infinite), 1.0);
    EXPECT_EQ(traced(Cuboid{}, {0.3f, 1, 0.9f}, infinite), 1.0);
}

TEST(Traced, DependsOnThePlaceAndTheSeedAlone) {
    const Union field(Plane{}, Plane{{1, 0, 0}, 0.0f});
    std::vector<Surfel> surfels;
    for (int i = 0; i < 5000; ++i)
        surfels.push_back({{0.001f * static_cast<float>(i % 977), 0, 0.01f * static_cast<float>(i)}, {0, 1, 0}});
    const Traced estimator{.radius = 0.5f, .rays = 8};
    const std::vector<float> ao = evaluate_ao(surfels, field, estimator);
    const std::vector<Surfel> reversed(surfels.rbegin(), surfels.rend());
    const std::vector<float> backward = evaluate_ao(reversed, field, estimator);
    EXPECT_TRUE(std::equal(ao.begin(), ao.end(), backward.rbegin()));
    const ThreadLimit one(1);
    EXPECT_EQ(evaluate_ao(surfels, field, estimator), ao);
    EXPECT_NE(evaluate_ao(surfels, field, Traced{.radius = 0.5f, .rays = 8, .seed = 1}), ao);
}

}
}
