#include "alcove/field/detail/trace.h"
#include "alcove/occlusion/detail/fan.h"
#include "alcove/occlusion/occluders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace alcove {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Vec3 random_point(std::mt19937& random) {
    std::uniform_real_distribution<float> coordinate(-0.5f, 0.5f);
    const float x = coordinate(random), y = coordinate(random), z = coordinate(random);
    return {x, y, z};
}

Vec3d random_direction(std::mt19937& random) {
    return glm::normalize(Vec3d(random_point(random)));
}

struct Triangles {
    std::vector<Vec3> positions{Vec3(0.1f, -0.2f, 0.05f)}; ///< the hub first
    std::vector<Triangle> triangles;

    Vec3d corner(std::size_t t, int c) const { return Vec3d(positions[triangles[t][c]]); }
};

/// A ring of triangles around the hub. `height` is the height of the hub above the ring, and `waves` is the amplitude
/// of the waves of the ring.
Triangles ring(std::uint32_t count, float height, float waves) {
    Triangles result;
    const Vec3 hub = result.positions.front();
    for (std::uint32_t i = 0; i < count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / count;
        result.positions.push_back(
            hub + Vec3(0.3 * std::cos(angle), 0.3 * std::sin(angle), waves * std::sin(40.0 * angle) - height));
        result.triangles.push_back({0, 1 + i, 1 + (i + 1) % count});
    }
    return result;
}

/// Thin and wide triangles in all directions.
Triangles urchin(std::uint32_t count) {
    Triangles result;
    std::mt19937 random(3);
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vec3 tip = random_point(random), aside = random_point(random);
        result.positions.push_back(tip);
        result.positions.push_back(tip + (i % 8 == 0 ? 1.0f : 0.01f) * aside);
        result.triangles.push_back({0, 1 + 2 * i, 2 + 2 * i});
    }
    return result;
}

/// The distance to the nearest hit, by the determinants of each triangle (Möller and Trumbore 1997).
double nearest_hit(const Triangles& shape, const RaySegment& ray) {
    double nearest = infinity;
    for (std::size_t t = 0; t < shape.triangles.size(); ++t) {
        const Vec3d origin = shape.corner(t, 0), a = shape.corner(t, 1) - origin, b = shape.corner(t, 2) - origin;
        const Vec3d p = glm::cross(ray.direction, b), from = ray.origin - origin, q = glm::cross(from, a);
        const double determinant = glm::dot(a, p), u = glm::dot(from, p) / determinant,
                     v = glm::dot(ray.direction, q) / determinant, distance = glm::dot(b, q) / determinant;
        if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance >= ray.near && distance <= ray.far)
            nearest = std::min(nearest, distance);
    }
    return nearest;
}

/// Rays from all around, from beside the hub or a triangle, and past the hub.
RaySegment random_ray(const Triangles& shape, std::mt19937& random) {
    RaySegment ray{Vec3d(random_point(random)), random_direction(random), 0.0, infinity};
    const std::size_t t = random() % shape.triangles.size();
    switch (random() % 4) {
    case 0:
        ray.origin = Vec3d(shape.positions.front()) + 1e-4 * random_direction(random);
        break;
    case 1:
        ray.origin = 0.4 * shape.corner(t, 0) + 0.3 * shape.corner(t, 1) + 0.3 * shape.corner(t, 2) +
                     1e-4 * random_direction(random);
        break;
    case 2:
        ray.direction = glm::normalize(shape.corner(t, 0) + 1e-5 * random_direction(random) - ray.origin);
        break;
    default:
        break;
    }
    if (random() % 2)
        ray.far = 0.2;
    if (random() % 4 == 0)
        ray.near = 0.1;
    return ray;
}

TEST(Fan, FindsTheSameHitsAsEveryTriangleAlone) {
    for (const Triangles& shape :
         {ring(3, 0.1f, 0.0f), ring(500, 0.0f, 0.0f), ring(500, 0.3f, 0.0f), ring(500, 0.1f, 0.05f), urchin(300)}) {
        const Fan fan(shape.positions, shape.triangles);
        std::mt19937 random(1);
        int hits = 0;
        for (int i = 0; i < 4000; ++i) {
            const RaySegment ray = random_ray(shape, random);
            const double expected = nearest_hit(shape, ray);
            const std::optional<Fan::Hit> nearest = fan.find(ray, Fan::Wanted::nearest);
            ASSERT_EQ(fan.find(ray, Fan::Wanted::any).has_value(), std::isfinite(expected)) << i;
            ASSERT_EQ(nearest.has_value(), std::isfinite(expected)) << i;
            if (!nearest)
                continue;
            ++hits;
            ASSERT_NEAR(nearest->distance, expected, 1e-9) << i;
            const Triangle& t = fan.triangles()[nearest->triangle];
            Vec3d place(0.0);
            for (int c = 0; c < 3; ++c)
                place += nearest->weights[c] * Vec3d(shape.positions[t[c]]);
            ASSERT_LT(glm::length(place - (ray.origin + nearest->distance * ray.direction)), 1e-9) << i;
        }
        EXPECT_GT(hits, 200);
    }
}

/// The hub is not the first corner, some triangles cannot be hit, and one is not at the hub.
TEST(Fan, TakesAllTrianglesAroundAVertexWithMany) {
    Triangles shape = ring(smallest_fan, 0.1f, 0.0f);
    for (std::size_t i = 0; i < shape.triangles.size(); ++i)
        std::rotate(shape.triangles[i].begin(), shape.triangles[i].begin() + i % 3, shape.triangles[i].end());
    std::vector<Triangle> all = shape.triangles, others;
    const auto nowhere = static_cast<std::uint32_t>(shape.positions.size());
    shape.positions.emplace_back(std::numeric_limits<float>::quiet_NaN());
    shape.positions.push_back(shape.positions[7]);
    for (const Triangle& t : {Triangle{0, 1, nowhere}, {0, 5, 5}, {0, 7, nowhere + 1}, {3, 4, 5}})
        all.push_back(t);
    const std::vector<Fan> fans = fans_of(shape.positions, all, others);
    ASSERT_EQ(fans.size(), 1u);
    EXPECT_EQ(others, (std::vector<Triangle>{{3, 4, 5}}));
    std::vector<Triangle> taken = fans.front().triangles();
    std::sort(taken.begin(), taken.end());
    std::vector<Triangle> expected = ring(smallest_fan, 0.1f, 0.0f).triangles;
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(taken, expected);

    others.clear();
    shape.triangles.pop_back();
    EXPECT_TRUE(fans_of(shape.positions, shape.triangles, others).empty());
    EXPECT_TRUE(others.empty());
}

/// Rays through the batch interface, next to a triangle that is in no fan; normals have the orientation of the
/// triangles.
TEST(Fan, IsPartOfARaySurface) {
    Triangles shape = ring(2 * smallest_fan, 0.0f, 0.0f);
    const auto first = static_cast<std::uint32_t>(shape.positions.size());
    for (const Vec3& p : {Vec3(0, -0.3f, 0.3f), Vec3(0.3f, -0.3f, 0.3f), Vec3(0.1f, 0.1f, 0.3f)})
        shape.positions.push_back(p);
    shape.triangles.push_back({first, first + 1, first + 2});
    const RaySurface surface(shape.positions, shape.triangles);
    RayBatch rays;
    rays.push_back({{0.15f, -0.25f, 0.1f}, {0, 0, -1}}, 0.0f);  // the fan
    rays.push_back({{0.15f, -0.25f, 0.1f}, {0, 0, 1}}, 0.0f);   // the other triangle
    rays.push_back({{0.15f, -0.25f, 0.4f}, {0, 0, -1}}, 0.0f);  // both
    rays.push_back({{0.15f, 0.4f, 0.4f}, {0, 0, -1}}, 0.0f);    // neither
    rays.push_back({{0.15f, -0.25f, 0.1f}, {0, 0, -1}}, 0.06f); // begins behind the fan
    std::vector<SurfaceHit> hits(rays.count);
    RayBatch shadows = rays;
    surface.find_nearest(rays, 1.0f, hits);
    surface.find_occluded(shadows, 1.0f);
    const std::vector<bool> expected{true, true, true, false, false};
    for (std::size_t i = 0; i < rays.count; ++i) {
        EXPECT_EQ(rays.hit[i], expected[i]) << i;
        EXPECT_EQ(shadows.hit[i], expected[i]) << i;
    }
    EXPECT_NEAR(rays.travelled[0], 0.05f, 1e-6f);
    EXPECT_NEAR(rays.travelled[2], 0.1f, 1e-6f);
    EXPECT_NE(hits[0].vertices[0], first);
    EXPECT_EQ(std::count(hits[0].vertices.begin(), hits[0].vertices.end(), 0u), 1);
    // Both triangles are counter-clockwise from above.
    EXPECT_GT(hits[0].normal.z * hits[1].normal.z, 0.0f);
}

}
}
