/// Levels that exist only near walls and gaps thinner than two voxels.
#include "alcove/base/parallel.h"
#include "alcove/field/level_stack.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/triangulate.h"
#include "exact_distance.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace alcove {
namespace {

GridStack stack_of(const Mesh& mesh, float voxel = 0.0f) {
    VoxelizeOptions options;
    options.grid.voxel = voxel;
    options.grid.radius = 0.1f;
    return voxelize(mesh, triangulate(mesh).triangles, options);
}

/// A box from `low` to `high`.
void add_box(Mesh& mesh, const Vec3d& low, const Vec3d& high) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i < 8; ++i)
        mesh.positions.emplace_back((i & 4) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                                    (i & 1) != 0 ? high.z : low.z);
    for (const auto& [a, b, c, d] : std::array<std::array<std::uint32_t, 4>, 6>{
             {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}})
        mesh.add_face(std::array{first + a, first + b, first + c, first + d});
}

constexpr double voxel = 1.0 / 256.0; // of the diagonal, which is 1 here

/// A cube with a small plate beside it that is `thickness` voxels thick. The plate is not rotated, and its position is
/// not a multiple of the voxel.
Mesh cube_and_plate(double thickness) {
    Mesh mesh;
    add_box(mesh, {-0.3, -0.3, -0.3}, {0.1, 0.3, 0.3});
    add_box(mesh, {0.2, -0.1, -0.1}, {0.2 + thickness * voxel, 0.1, 0.1});
    const double scale = 1.0 / frame_of(mesh.box()).diagonal;
    for (Vec3d& p : mesh.positions)
        p *= scale;
    return mesh;
}

/// The largest error of distances near the plate, in voxels, among points on a line through it.
double error_near_plate(const GridStack& stack, const Mesh& mesh) {
    const LevelStack field(stack);
    const auto triangles = triangulate(mesh).triangles;
    const test::ExactSurface exact(mesh, triangles, stack.frame);
    const Vec3d plate = mesh.positions[8];
    double largest = 0.0;
    for (int i = -300; i <= 300; ++i) {
        Vec3d p = plate;
        p.x += i * 0.01 * voxel;
        p.y += 0.0123, p.z += 0.0234;
        const Vec3 at = stack.frame.to_unit(p);
        const double sign = exact.winding_number(at) > 0.5 ? -1.0 : 1.0;
        const double wanted = std::max(sign * exact.distance(at), -0.25 * voxel); // depths are known to a fine voxel
        largest = std::max(largest, std::fabs(std::max<double>(field.map(at), -0.25 * voxel) - wanted));
    }
    return largest / voxel;
}

TEST(PartialLevels, ResolveThinWalls) {
    for (const double thickness : {0.4, 0.7, 1.3, 1.8}) {
        const Mesh mesh = cube_and_plate(thickness);
        const GridStack whole = stack_of(mesh, float(voxel)), refined = stack_of(mesh);
        EXPECT_TRUE(whole.partial.empty());
        ASSERT_EQ(refined.partial.size(), thickness < 1.0 ? 2u : 1u) << thickness;
        EXPECT_FLOAT_EQ(float(refined.levels[0].voxel), float(whole.levels[0].voxel));
        EXPECT_FLOAT_EQ(float(refined.partial.back().voxel), float(0.5 * whole.levels[0].voxel));
        const double before = error_near_plate(whole, mesh), after = error_near_plate(refined, mesh);
        EXPECT_LT(after, 0.13) << thickness;
        EXPECT_LT(after, before + 0.01) << thickness;
        EXPECT_LT(refined.bytes(), 2 * whole.bytes());
    }
}

TEST(PartialLevels, ResolveNarrowGaps) {
    Mesh mesh;
    add_box(mesh, {-0.3, -0.3, -0.3}, {0.1, 0.3, 0.3});
    add_box(mesh, {0.1 + 0.7 * voxel, -0.05, -0.05}, {0.2, 0.05, 0.05});
    const GridStack stack = stack_of(mesh);
    ASSERT_EQ(stack.partial.size(), 2u);
    const LevelStack field(stack);
    const double in_gap = 0.35 * voxel, scale = stack.frame.diagonal;
    EXPECT_NEAR(field.map(stack.frame.to_unit({0.1 + in_gap, 0.01, 0.02})) * scale, in_gap,
                0.13 * voxel); // half a fine voxel is cut off the ridge
    EXPECT_LT(field.map(stack.frame.to_unit({0.1 - in_gap, 0.01, 0.02})), 0.0f);
    EXPECT_LT(field.map(stack.frame.to_unit({0.1 + 2.0 * voxel, 0.01, 0.02})), 0.0f);
}

TEST(PartialLevels, DoNotExistWhereNothingIsThin) {
    EXPECT_TRUE(stack_of(test::sphere_mesh(5)).partial.empty());
    Mesh box;
    add_box(box, {0, 0, 0}, {1, 2, 3});
    EXPECT_TRUE(stack_of(box).partial.empty());
    // All of it is thin: only a finer voxel helps.
    Mesh plate;
    add_box(plate, {0, 0, 0}, {1, 1, 0.005});
    EXPECT_TRUE(stack_of(plate).partial.empty());
}

TEST(PartialLevels, SheetsHaveThemToo) {
    Mesh mesh = cube_and_plate(0.7);
    const auto last = mesh.face_count() - 1; // open the cube
    Mesh open;
    open.positions = mesh.positions;
    for (std::size_t f = 1; f <= last; ++f)
        open.add_face(mesh.face(f));
    const GridStack stack = stack_of(open);
    ASSERT_EQ(stack.sign, Sign::sheet);
    ASSERT_EQ(stack.partial.size(), 2u);
    const LevelStack field(stack);
    const Vec3d plate = open.positions[8];
    const auto at = [&](double x) {
        return std::fabs(field.map(stack.frame.to_unit({plate.x + x * voxel, plate.y + 0.0123, plate.z + 0.0234}))) /
               voxel * stack.frame.diagonal;
    };
    for (const double x : {-1.0, -0.5, -0.2})
        EXPECT_NEAR(at(x), -x, 0.1) << x;
    for (const double x : {0.2, 0.5, 1.0})
        EXPECT_NEAR(at(0.7 + x), x, 0.1) << x;
}

TEST(PartialLevels, BatchesAndThreadsGiveTheSameValues) {
    const Mesh mesh = cube_and_plate(0.7);
    const auto with = [&](unsigned threads) {
        const ThreadLimit limit(threads);
        return stack_of(mesh);
    };
    const GridStack one = with(1), four = with(4);
    const LevelStack field(one), other(four);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> noise(-0.02f, 0.02f);
    const Vec3 plate = one.frame.to_unit(mesh.positions[8] + Vec3d(0.0, 0.05, 0.05));
    std::vector<float> x, y, z;
    for (int i = 0; i < 5000; ++i) {
        x.push_back(plate.x + noise(random));
        y.push_back(plate.y + noise(random));
        z.push_back(plate.z + noise(random));
    }
    std::vector<float> batch(x.size()), again(x.size());
    field.map({x.data(), y.data(), z.data(), x.size()}, any_reach, batch.data());
    other.map({x.data(), y.data(), z.data(), x.size()}, any_reach, again.data());
    EXPECT_EQ(batch, again);
    for (std::size_t i = 0; i < x.size(); ++i)
        ASSERT_NEAR(batch[i], field.map({x[i], y[i], z[i]}), 1e-5f) << i;
}

}
}
