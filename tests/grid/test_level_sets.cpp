/// Compares every voxel of level sets with brute force, closed forms and another voxelizer.
#include "alcove/base/parallel.h"
#include "alcove/base/types.h"
#include "alcove/grid/detail/vdb_grid.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/triangulate.h"
#include "shapes.h"

#include <gtest/gtest.h>
#include <openvdb/tools/MeshToVolume.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace alcove {
namespace {

GridStack stack_of(const Mesh& mesh, float voxel, float radius, SignChoice sign = SignChoice::automatic) {
    VoxelizeOptions options;
    options.grid.voxel = voxel;
    options.grid.radius = radius;
    options.sign = sign;
    return voxelize(mesh, triangulate(mesh).triangles, options);
}

/// Calls `visit(centre in scene units, value in voxels)` for each active voxel.
template <class Visit>
void for_each_voxel(const GridStack& stack, const LevelSet& level, Visit&& visit) {
    const double scale = stack.value_unit / (level.voxel * stack.frame.diagonal);
    for (auto voxel = level.grid->grid->cbeginValueOn(); voxel; ++voxel) {
        const auto at = voxel.getCoord();
        const Vec3d unit = Vec3d(level.origin) + double(level.voxel) * Vec3d(at.x(), at.y(), at.z());
        visit(unit * stack.frame.diagonal + stack.frame.center, *voxel * scale);
    }
}

double segment_distance(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
    const double length2 = glm::dot(b - a, b - a);
    const double t = length2 > 0.0 ? std::clamp(glm::dot(p - a, b - a) / length2, 0.0, 1.0) : 0.0;
    return glm::length(p - a - t * (b - a));
}

double triangle_distance(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const double sides = std::min({segment_distance(p, a, b), segment_distance(p, b, c), segment_distance(p, c, a)});
    const Vec3d n = glm::cross(b - a, c - a);
    const bool over = glm::dot(glm::cross(b - a, p - a), n) >= 0.0 && glm::dot(glm::cross(c - b, p - b), n) >= 0.0 &&
                      glm::dot(glm::cross(a - c, p - c), n) >= 0.0 && glm::dot(n, n) > 0.0;
    return over ? std::min(sides, std::fabs(glm::dot(p - a, n)) / glm::length(n)) : sides;
}

/// Random triangles in a unit cube with sides about `size` long; every third is a sliver.
Mesh soup(int triangles, double size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit;
    const auto anywhere = [&] { return Vec3d(unit(random), unit(random), unit(random)); };
    Mesh mesh;
    for (int t = 0; t < triangles; ++t) {
        const Vec3d at = anywhere(), b = at + size * (anywhere() - 0.5);
        const double narrow = t % 3 == 0 ? 1e-3 : 1.0;
        for (const Vec3d& p : {at, b, at + 0.5 * (b - at) + narrow * size * (anywhere() - 0.5)})
            mesh.positions.push_back(p);
        const auto first = static_cast<std::uint32_t>(3 * t);
        mesh.add_face(std::array{first, first + 1, first + 2});
    }
    return mesh;
}

TEST(LevelSets, DistancesToTriangleSoupsAreThoseOfBruteForce) {
    for (const auto& [count, size] : {std::pair(3, 1.5), std::pair(30, 0.5), std::pair(300, 0.02)}) {
        const Mesh mesh = soup(count, size, 7);
        const GridStack stack = stack_of(mesh, 1.0f / 32.0f, 0.4f, SignChoice::sheet);
        ASSERT_GE(stack.levels.size(), 3u);
        for (const LevelSet& level : stack.levels) {
            double largest = 0.0;
            const double unit = level.voxel * stack.frame.diagonal;
            for_each_voxel(stack, level, [&](const Vec3d& p, double value) {
                double exact = INFINITY;
                for (std::size_t t = 0; t < mesh.positions.size(); t += 3)
                    exact = std::min(
                        exact, triangle_distance(p, mesh.positions[t], mesh.positions[t + 1], mesh.positions[t + 2]));
                largest = std::max(largest, std::fabs(std::fabs(value) - exact / unit));
            });
            EXPECT_LE(largest, 1e-4) << count << " triangles, voxel " << level.voxel;
        }
    }
}

/// The band consists of exactly the voxels within its width.
TEST(LevelSets, NoVoxelOfTheBandIsMissing) {
    const Mesh mesh = soup(20, 0.3, 3);
    const GridStack stack = stack_of(mesh, 1.0f / 24.0f, 0.4f, SignChoice::sheet);
    ASSERT_GE(stack.levels.size(), 3u);
    for (const LevelSet& level : stack.levels) {
        const double unit = level.voxel * stack.frame.diagonal;
        const auto accessor = level.grid->grid->getConstAccessor();
        const int side = static_cast<int>(3.2f / level.voxel);
        for (int x = 0; x < side; ++x)
            for (int y = 0; y < side; ++y)
                for (int z = 0; z < side; ++z) {
                    const Vec3d p =
                        (Vec3d(level.origin) + double(level.voxel) * Vec3d(x, y, z)) * stack.frame.diagonal +
                        stack.frame.center;
                    double exact = INFINITY;
                    for (std::size_t t = 0; t < mesh.positions.size(); t += 3)
                        exact = std::min(exact, triangle_distance(p, mesh.positions[t], mesh.positions[t + 1],
                                                                  mesh.positions[t + 2]));
                    if (std::fabs(exact / unit - level.outer_band) > 1e-4) {
                        ASSERT_EQ(accessor.isValueOn({x, y, z}), exact / unit < level.outer_band);
                    }
                }
    }
}

TEST(LevelSets, AgreeWithOpenVdbOnASphere) {
    const Mesh mesh = test::sphere_mesh(5);
    const GridStack stack = stack_of(mesh, 1.0f / 64.0f, 0.05f);
    const LevelSet& level = stack.levels.front();
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    for (const Vec3d& p : mesh.positions) {
        const Vec3d q = ((p - stack.frame.center) / stack.frame.diagonal - Vec3d(level.origin)) / double(level.voxel);
        points.emplace_back(q.x, q.y, q.z);
    }
    for (const Triangle& t : triangulate(mesh).triangles)
        triangles.emplace_back(t[0], t[1], t[2]);
    const auto theirs = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I>(points, triangles),
        *openvdb::math::Transform::createLinearTransform(1.0), 5.0f, 2.0f,
        openvdb::tools::DISABLE_INTERSECTING_VOXEL_REMOVAL | openvdb::tools::DISABLE_RENORMALIZATION);
    const auto accessor = theirs->getConstAccessor();
    const double scale = stack.value_unit / (level.voxel * stack.frame.diagonal);
    std::size_t compared = 0;
    for (auto voxel = level.grid->grid->cbeginValueOn(); voxel; ++voxel)
        if (std::fabs(*voxel * scale) < 0.9) {
            EXPECT_NEAR(*voxel * scale, accessor.getValue(voxel.getCoord()), 1e-3);
            ++compared;
        }
    EXPECT_GT(compared, 1000u);
}

TEST(LevelSets, DoNotDependOnTheThreads) {
    for (const Mesh& mesh : {test::sphere_mesh(5), soup(500, 0.1, 5)}) {
        std::vector<GridStack> stacks;
        for (const unsigned threads : {1u, 2u, 4u}) {
            const ThreadLimit limit(threads);
            stacks.push_back(stack_of(mesh, 1.0f / 100.0f, 0.3f));
        }
        for (std::size_t l = 0; l < stacks[0].levels.size(); ++l)
            for (const GridStack& other : stacks) {
                const auto &a = stacks[0].levels[l].grid->grid->tree(), &b = other.levels[l].grid->grid->tree();
                ASSERT_TRUE(a.hasSameTopology(b));
                auto there = b.cbeginValueAll();
                for (auto here = a.cbeginValueAll(); here; ++here, ++there)
                    ASSERT_EQ(*here, *there);
            }
    }
}

struct Ball {
    Vec3d centre;
    double radius;
    bool hollow = false; // a cavity: faces inward
};

Mesh balls_mesh(const std::vector<Ball>& balls) {
    Mesh mesh;
    for (const Ball& ball : balls)
        test::add_part(mesh, test::sphere_mesh(4), ball.hollow ? -ball.radius : ball.radius, ball.centre);
    return mesh;
}

double signed_distance(const Ball& ball, const Vec3d& p) {
    return glm::length(p - ball.centre) - ball.radius;
}

TEST(Signs, OverlappingBallsAreOneSolid) {
    const std::vector<Ball> balls{{{0, 0, 0}, 1.0}, {{1.2, 0.3, 0}, 0.8}, {{0.5, -0.9, 0.4}, 0.6}};
    const GridStack stack = stack_of(balls_mesh(balls), 1.0f / 96.0f, 0.2f);
    ASSERT_EQ(stack.sign, Sign::solid);
    for (const LevelSet& level : stack.levels)
        for_each_voxel(stack, level, [&](const Vec3d& p, double value) {
            double outside = INFINITY;
            for (const Ball& ball : balls)
                outside = std::min(outside, signed_distance(ball, p));
            if (std::fabs(outside) > 0.01) { // the facets are up to this far inside the ball
                ASSERT_EQ(value < 0.0, outside < 0.0);
            }
        });
}

TEST(Signs, ACavityIsAir) {
    const std::vector<Ball> balls{{{0, 0, 0}, 1.0}, {{0.1, 0, 0}, 0.5, true}};
    const GridStack stack = stack_of(balls_mesh(balls), 1.0f / 96.0f, 0.2f);
    ASSERT_EQ(stack.sign, Sign::solid);
    for (const LevelSet& level : stack.levels)
        for_each_voxel(stack, level, [&](const Vec3d& p, double value) {
            const double outside = std::max(signed_distance(balls[0], p), -signed_distance(balls[1], p));
            if (std::fabs(outside) > 0.01) {
                ASSERT_EQ(value < 0.0, outside < 0.0);
            }
        });
}

TEST(Signs, ShellsInShellsAndShellsInsideOutStaySheets) {
    const Ball outer{{0, 0, 0}, 1.0}, inner{{0.1, 0, 0}, 0.5}, beside{{2, 0, 0}, 0.5};
    const auto sign = [](const std::vector<Ball>& balls) {
        return stack_of(balls_mesh(balls), 1.0f / 64.0f, 0.1f).sign;
    };
    EXPECT_EQ(sign({outer, beside}), Sign::solid);
    EXPECT_EQ(sign({outer, inner}), Sign::sheet);
    EXPECT_EQ(sign({outer, inner, beside}), Sign::sheet);
    EXPECT_EQ(sign({{{0, 0, 0}, 1.0, true}}), Sign::sheet);
    EXPECT_EQ(sign({outer, {{2, 0, 0}, 0.5, true}}), Sign::sheet);
    // A cavity with a core: three shells, which all bound the solid.
    EXPECT_EQ(sign({outer, {{0.1, 0, 0}, 0.5, true}, {{0.1, 0, 0}, 0.2}}), Sign::solid);
}

/// Faces, edges and corners of boxes on columns of voxels: each column is assigned to exactly one of two neighbours.
TEST(Signs, BoxesOnTheLatticeAreClosed) {
    Mesh mesh = test::box_mesh({1, 1, 1}, 16);
    test::add_part(mesh, test::box_mesh({1, 1, 1}, 16), 0.5, {1, 0.25, 0.125});
    const double diagonal = mesh.box().diagonal();
    const GridStack stack = stack_of(mesh, static_cast<float>(0.125 / diagonal), 0.2f);
    ASSERT_EQ(stack.sign, Sign::solid);
    for_each_voxel(stack, stack.levels.front(), [&](const Vec3d& p, double value) {
        const Vec3d a = glm::abs(p) - 1.0, b = glm::abs(p - Vec3d(1, 0.25, 0.125)) - 0.5;
        const double outside = std::min(std::max({a.x, a.y, a.z}), std::max({b.x, b.y, b.z}));
        if (std::fabs(outside) > 1e-4) {
            ASSERT_EQ(value < 0.0, outside < 0.0);
        }
    });
}

}
}
