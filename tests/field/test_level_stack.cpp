#include "alcove/field/detail/bricks.h"
#include "alcove/field/level_stack.h"

#include "alcove/field/primitives.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/triangulate.h"
#include "exact_distance.h"
#include "real_mesh.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace alcove {
namespace {

GridStack stack_of(const Mesh& mesh, float voxel, float radius) {
    VoxelizeOptions options;
    options.grid.voxel = voxel;
    options.grid.radius = radius;
    return voxelize(mesh, triangulate(mesh).triangles, options);
}

struct PointCloud {
    std::vector<float> x, y, z;

    void push_back(const Vec3& p) { x.push_back(p.x), y.push_back(p.y), z.push_back(p.z); }
    Points points() const { return {x.data(), y.data(), z.data(), x.size()}; }
};

PointCloud random_points(float extent, std::size_t count) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> coordinate(-extent, extent);
    PointCloud cloud;
    for (std::size_t i = 0; i < count; ++i)
        cloud.push_back({coordinate(random), coordinate(random), coordinate(random)});
    return cloud;
}

TEST(LevelStack, KnowsTheInsideAsFarAsTheOutsideWhereItsLevelsDo) {
    VoxelizeOptions options;
    options.grid.voxel = 1.0f / 128.0f;
    options.grid.radius = 0.25f;
    const Mesh ball = test::sphere_mesh(5); // the diagonal of its box is √12 radii
    const auto triangles = triangulate(ball).triangles;
    const LevelStack thin(voxelize(ball, triangles, options));
    options.grid.inner_band = options.grid.outer_band;
    const LevelStack thick(voxelize(ball, triangles, options));
    const float radius = 1.0f / std::sqrt(12.0f);
    for (const float depth : {0.005f, 0.02f, 0.06f, 0.12f}) {
        const Vec3 p = (radius - depth) * glm::normalize(Vec3(1.0f, 2.0f, -0.5f));
        EXPECT_NEAR(thick.map(p), -depth, 0.03f * depth + 1e-4f);
        float batched = 0.0f;
        thick.map({&p.x, &p.y, &p.z, 1}, any_reach, &batched);
        EXPECT_NEAR(batched, thick.map(p), 1e-6f);
        EXPECT_GE(thin.map(p), -5.0f / 128.0f - 1e-6f); // the value that fills its inside
    }
}

TEST(LevelStack, SimdSamplerEqualsItsScalarTwin) {
    const LevelStack field(stack_of(test::sphere_mesh(4), 1.0f / 64.0f, 0.3f));
    const PointCloud cloud = random_points(0.8f, 4099); // extends beyond the grid; not a multiple of any lane count
    std::vector<float> simd(cloud.x.size());
    for (const Bricks& level : field.levels()) {
        sample_bricks(level.view(), cloud.points(), simd.data());
        for (std::size_t i = 0; i < simd.size(); ++i)
            EXPECT_NEAR(simd[i], level.map(cloud.points()[i]), 1e-5f * level.voxel() + 1e-6f);
    }
    map_batch(field, cloud.points(), any_reach, simd.data());
    for (std::size_t i = 0; i < simd.size(); ++i)
        EXPECT_NEAR(simd[i], field.map(cloud.points()[i]), 1e-6f);
}

TEST(LevelStack, FarDistancesComeFromCoarserLevelsAndNeverSaturate) {
    const Mesh mesh = test::sphere_mesh(5); // diagonal of its box: 2√3
    const LevelStack field(stack_of(mesh, 1.0f / 128.0f, 0.5f));
    const Sphere sphere{Vec3(0.0f), static_cast<float>(0.5 / std::sqrt(3.0))};
    EXPECT_GE(field.reach(), 0.5f);
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> unit;
    for (int i = 0; i < 5000; ++i) {
        const Vec3 direction = glm::normalize(Vec3(normal(random), normal(random), normal(random)));
        const float height = 0.5f * unit(random);
        const float d = field.map((sphere.radius + height) * direction);
        // The voxel of the level in use is at most half the distance, or the finest one.
        const float voxel = std::max(0.5f * height, 1.0f / 128.0f);
        EXPECT_NEAR(d, height, 0.06f * voxel) << "at height " << height;
    }
}

TEST(LevelStack, FarOutTheAnswerIsABoundThatGrowsWithTheDistance) {
    const LevelStack field(stack_of(test::sphere_mesh(4), 1.0f / 64.0f, 0.1f));
    const Sphere sphere{Vec3(0.0f), static_cast<float>(0.5 / std::sqrt(3.0))};
    EXPECT_GE(field.extent(), sphere.radius);
    EXPECT_LT(field.extent(), 0.8f);
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    for (const float far : {0.5f, 1.0f, 3.0f, 100.0f}) {
        PointCloud cloud;
        for (int i = 0; i < 300; ++i)
            cloud.push_back(far * glm::normalize(Vec3(normal(random), normal(random), normal(random))));
        std::vector<float> distances(cloud.x.size());
        map_batch(field, cloud.points(), any_reach, distances.data());
        for (std::size_t i = 0; i < distances.size(); ++i) {
            const Vec3 p = cloud.points()[i];
            EXPECT_EQ(distances[i], field.map(p));
            EXPECT_LE(distances[i], 1.0001f * sphere.map(p) + 1e-3f);
            // The distance to the bounding box of the surface is a lower bound.
            EXPECT_GE(distances[i], std::max(field.reach(), sphere.map(p) - field.extent()));
        }
    }
}

TEST(LevelStack, ProbesOfKnownReachReadOneLevelAndAgree) {
    const test::RealMesh real("elephant.off");
    const LevelStack field(stack_of(real.mesh, 1.0f / 128.0f, 0.2f));
    const test::ExactSurface exact(real.mesh, real.triangles, real.frame);
    std::mt19937 random(6);
    std::uniform_real_distribution<float> unit;
    for (const float reach : {0.01f, 0.04f, 0.1f, 0.2f}) {
        PointCloud cloud;
        while (cloud.x.size() < 500) {
            const Vec3 p = exact.point(random() % exact.size(), unit(random), unit(random)) +
                           reach * (2.0f * Vec3(unit(random), unit(random), unit(random)) - 1.0f);
            if (const double d = exact.distance(p); d < reach && exact.winding_number(p) < 0.5)
                cloud.push_back(p);
        }
        std::vector<float> distances(cloud.x.size());
        map_batch(field, cloud.points(), reach, distances.data());
        double sum = 0.0;
        for (std::size_t i = 0; i < distances.size(); ++i)
            sum += std::fabs(distances[i] - exact.distance(cloud.points()[i]));
        EXPECT_LE(sum / static_cast<double>(distances.size()), 0.03 * std::max(reach, 1.0f / 128.0f));
    }
}

/// Between voxel centres the only error is that of trilinear interpolation.
TEST(LevelStack, ErrorBetweenCentresIsThatOfInterpolatingExactValues) {
    const test::RealMesh real("fandisk.off");
    const LevelStack field(stack_of(real.mesh, 1.0f / 64.0f, 0.05f));
    const test::ExactSurface exact(real.mesh, real.triangles, real.frame);
    const float voxel = field.resolution();
    const auto truth = [&](const Vec3& p) { return exact.distance(p) * (exact.winding_number(p) > 0.5 ? -1.0 : 1.0); };
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit;
    double ours = 0.0, ideal = 0.0;
    for (int i = 0; i < 1000;) {
        const Vec3 p = exact.point(random() % exact.size(), unit(random), unit(random)) +
                       3.0f * voxel * (2.0f * Vec3(unit(random), unit(random), unit(random)) - 1.0f);
        const double d = truth(p);
        if (d < -0.5 * voxel || d > 3.0 * voxel)
            continue;
        ++i;
        const Vec3 origin = field.levels().front().origin();
        const Vec3 low = glm::floor((p - origin) / voxel), t = (p - origin) / voxel - low;
        double interpolated = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 step(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
            const Vec3 weight = glm::mix(1.0f - t, t, step);
            interpolated += double(weight.x * weight.y * weight.z) * truth(origin + voxel * (low + step));
        }
        ours += (field.map(p) - d) * (field.map(p) - d);
        ideal += (interpolated - d) * (interpolated - d);
    }
    EXPECT_LE(std::sqrt(ours), 1.05 * std::sqrt(ideal));
}

TEST(LevelStack, MemoryHardlyGrowsWithTheRadius) {
    const test::RealMesh real("elephant.off");
    const auto bytes = [&](float radius) {
        const GridStack stack = stack_of(real.mesh, 1.0f / 256.0f, radius);
        return std::pair(stack.bytes(), LevelStack(stack).bytes());
    };
    const auto near = bytes(0.02f), far = bytes(0.5f);
    EXPECT_LT(static_cast<double>(far.first), 1.5 * static_cast<double>(near.first));
    EXPECT_LT(static_cast<double>(far.second), 1.5 * static_cast<double>(near.second));
}

}
}
