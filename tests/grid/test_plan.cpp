#include "alcove/grid/detail/plan.h"

#include "alcove/base/parallel.h"
#include "alcove/base/types.h"
#include "alcove/field/level_stack.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/triangulate.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alcove {
namespace {

LevelPlan plan(const Mesh& mesh, const GridOptions& options) {
    return plan_levels(mesh, triangulate(mesh).triangles, options);
}

TEST(Plan, TheLastLevelReachesTheRadius) {
    const Mesh mesh = test::sphere_mesh(3);
    for (const float radius : {0.001f, 0.02f, 0.1f, 0.5f, 1.0f, INFINITY}) {
        const LevelPlan p = plan(mesh, {.radius = radius});
        const float usable = (p.outer_band - 1.0f) * std::ldexp(p.voxel, p.levels - 1);
        EXPECT_GE(usable, std::min(radius, 1.0f));
        EXPECT_TRUE(p.levels == 1 || usable < 2.0f * std::min(radius, 1.0f));
        EXPECT_LE(p.voxel, 1.0f / 256.0f);
    }
}

TEST(Plan, AChosenVoxelIsAtMostTheLargest) {
    const Mesh mesh = test::sphere_mesh(3);
    EXPECT_EQ(plan(mesh, {}).voxel, 1.0f / 256.0f);
    EXPECT_EQ(plan(mesh, {.largest_voxel = 0.002f}).voxel, 0.002f);
    EXPECT_EQ(plan(mesh, {.voxel = 0.01f, .largest_voxel = 0.002f}).voxel, 0.01f);
}

TEST(Plan, AVoxelThatDoesNotFitIsRefusedWithOneThatDoes) {
    const Mesh mesh = test::sphere_mesh(3);
    try {
        plan(mesh, {.voxel = 1e-5f});
        FAIL();
    } catch (const LimitError& error) {
        const std::string message = error.what();
        const auto at = message.find("--voxel ");
        ASSERT_NE(at, std::string::npos) << message;
        const float percent = std::stof(message.substr(at + 8));
        EXPECT_NO_THROW(plan(mesh, {.voxel = percent / 100.0f})) << message;
        EXPECT_THROW(plan(mesh, {.voxel = 0.5f * percent / 100.0f}), LimitError) << message;
    }
    EXPECT_THROW(plan(mesh, {.voxel = 1e-30f}), LimitError);
}

TEST(Plan, AnAutomaticVoxelIsCoarsenedUntilItFits) {
    const Mesh mesh = test::sphere_mesh(3);
    const LevelPlan roomy = plan(mesh, {}), tight = plan(mesh, {.memory_limit = roomy.bytes / 4});
    EXPECT_GT(tight.voxel, 1.5f * roomy.voxel);
    EXPECT_LE(tight.bytes, roomy.bytes / 4);
}

TEST(Plan, TrianglesThatDoNotFitAreRefused) {
    const Mesh mesh = test::sphere_mesh(3);
    const std::vector<Triangle> triangles = triangulate(mesh).triangles;
    const GridOptions tiny{.memory_limit = 100.0 * static_cast<double>(triangles.size())};
    EXPECT_EQ(finest_voxel(surface_size(mesh, triangles), triangles.size(), tiny), INFINITY);
    EXPECT_THROW(plan(mesh, tiny), LimitError);
    EXPECT_THROW(plan(mesh, {.voxel = 0.5f, .memory_limit = tiny.memory_limit}), LimitError);
}

TEST(Plan, AVoxelFitsOrIsRefusedWhateverTheLimit) {
    const Mesh mesh = test::sphere_mesh(5);
    for (const bool cluster : {false, true}) {
        std::size_t refused = 0, clustered = 0, whole = 0;
        for (double limit = 1e5; limit < 1e9; limit *= 1.01)
            try {
                const LevelPlan p = plan(mesh, {.cluster = cluster, .memory_limit = limit});
                EXPECT_LE(p.bytes, limit);
                EXPECT_LE(p.voxel, 1.0f);
                ++(p.cluster ? clustered : whole);
            } catch (const LimitError&) {
                ++refused;
            }
        EXPECT_GT(refused, 0u);
        EXPECT_GT(whole, 0u);
        EXPECT_EQ(clustered > 0, cluster);
    }
}

/// The fragments of long triangles, at 60 bytes each, dominate the estimate.
TEST(Plan, NeedlesAreCountedByTheirLength) {
    Mesh needles;
    constexpr std::uint32_t count = 10'000;
    for (std::uint32_t i = 0; i <= count; ++i)
        needles.positions.emplace_back(i == count ? 0.0 : 1.0, 1e-7 * i, 0.0);
    for (std::uint32_t i = 0; i + 1 < count; ++i)
        needles.add_face(std::array{count, i, i + 1});
    EXPECT_GT(plan(needles, {.voxel = 1.0f / 1024}).bytes, 60.0 * count * 1024 / 2);
    EXPECT_THROW(plan(needles, {.voxel = 1.0f / 1024, .memory_limit = 3e8}), LimitError);
    const LevelPlan coarse = plan(needles, {.memory_limit = 3e8});
    EXPECT_LE(coarse.bytes, 3e8);
}

TEST(Plan, FinerVoxelsNeverTakeLess) {
    const Mesh mesh = test::sphere_mesh(5);
    for (const bool cluster : {false, true}) {
        double last = 0.0;
        for (float voxel = 0.5f; voxel > 1e-3f; voxel *= 0.97f) {
            const double bytes = plan(mesh, {.voxel = voxel, .cluster = cluster}).bytes;
            EXPECT_GT(bytes, last);
            last = bytes;
        }
    }
}

TEST(Plan, DenseSurfacesAreThinnedToWhatTheirVoxelsTell) {
    const GridOptions cluster{.cluster = true};
    EXPECT_EQ(triangles_voxelized(1.0, 1'000'000, 0.01, {}), 1e6);
    EXPECT_LT(triangles_voxelized(1.0, 1'000'000, 0.01, cluster), 2e5);
    EXPECT_EQ(triangles_voxelized(1.0, 10'000'000, 0.01, cluster), triangles_voxelized(1.0, 1'000'000, 0.01, cluster));
    EXPECT_EQ(triangles_voxelized(1.0, 1'000'000, 0.004, cluster), 1e6);
}

/// The estimate before allocation covers the allocated grids and bricks, and is not many times too high.
TEST(Plan, TheEstimateCoversTheGrids) {
    for (const Mesh& mesh : {test::sphere_mesh(5), test::box_mesh({1, 1, 1}, 4), test::box_mesh({1, 1, 0.001}, 4)}) {
        VoxelizeOptions options;
        options.grid.voxel = 1.0f / 200.0f;
        const GridStack stack = voxelize(mesh, triangulate(mesh).triangles, options);
        const double allocated = static_cast<double>(stack.bytes() + LevelStack(stack).bytes());
        const double estimate = plan(mesh, options.grid).bytes;
        EXPECT_LT(allocated, estimate);
        EXPECT_GT(allocated, estimate / 20.0);
    }
}

GridStack voxelize_moved(double scale, const Vec3d& move) {
    Mesh mesh;
    test::add_part(mesh, test::box_mesh({1, 0.5, 0.25}, 3), scale, move);
    VoxelizeOptions options;
    options.grid.voxel = 1.0f / 64.0f;
    return voxelize(mesh, triangulate(mesh).triangles, options);
}

TEST(Voxelize, NeitherScaleNorPlaceChangesTheField) {
    const LevelStack unit(voxelize_moved(1.0, Vec3d(0.0)));
    for (const auto& [scale, move] :
         {std::pair{1e-25, Vec3d(0.0)}, {1e25, Vec3d(0.0)}, {1e-3, Vec3d(1e3, -2e3, 5.0)}}) {
        const LevelStack moved(voxelize_moved(scale, move));
        for (int i = 0; i < 1000; ++i) {
            const Vec3 p = 0.6f * (2.0f * Vec3(i % 10, i / 10 % 10, i / 100) / 9.0f - 1.0f);
            EXPECT_NEAR(moved.map(p), unit.map(p), 1e-5f) << scale;
        }
    }
}

TEST(Voxelize, VerticesThatAreNoNumbersDoNotMatter) {
    const Mesh mesh = test::sphere_mesh(3);
    const GridStack alone = voxelize(mesh, triangulate(mesh).triangles);
    for (const Vec3d& invalid :
         {Vec3d(1e30, 0, NAN), Vec3d(0, 1e30, NAN), Vec3d(1e30, NAN, 0), Vec3d(INFINITY, 0, 0), Vec3d(NAN)}) {
        Mesh with = mesh;
        with.positions.push_back(invalid);
        const GridStack stack = voxelize(with, triangulate(with).triangles);
        EXPECT_EQ(stack.sign, alone.sign);
        EXPECT_EQ(stack.levels.front().active_voxels, alone.levels.front().active_voxels);
    }
}

TEST(Voxelize, ThreadsDoNotMatter) {
    const auto sample = [](unsigned threads) {
        const ThreadLimit limit(threads);
        const Mesh mesh = test::sphere_mesh(5);
        const LevelStack field(voxelize(mesh, triangulate(mesh).triangles));
        std::vector<float> values;
        for (int i = 0; i < 20000; ++i)
            values.push_back(
                field.map(0.4f * Vec3(std::sin(0.1f * static_cast<float>(i)), std::cos(0.37f * static_cast<float>(i)),
                                      std::sin(0.73f * static_cast<float>(i)))));
        return values;
    };
    EXPECT_EQ(sample(1), sample(2));
}

TEST(Voxelize, WithoutAnyAreaThereIsNothingToVoxelize) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
    mesh.add_face(std::vector<std::uint32_t>{0, 1, 2});
    EXPECT_THROW(voxelize(mesh, triangulate(mesh).triangles), InputError);
    EXPECT_THROW(voxelize(Mesh{}, {}), InputError);
}

TEST(Voxelize, ASingleTriangleIsASheet) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.add_face(std::vector<std::uint32_t>{0, 1, 2});
    const GridStack stack = voxelize(mesh, triangulate(mesh).triangles);
    EXPECT_EQ(stack.sign, Sign::sheet);
    const LevelStack field(stack);
    for (const float height : {0.003f, 0.02f, 0.05f, 0.1f}) {
        const Vec3 centre = stack.frame.to_unit({0.25, 0.25, 0});
        EXPECT_NEAR(field.map(centre + Vec3(0, 0, height)), height, 2e-4f);
        if (height > 3.0f * field.resolution()) {
            EXPECT_NEAR(field.map(centre - Vec3(0, 0, height)), height, 2e-4f);
        }
    }
}

}
}
