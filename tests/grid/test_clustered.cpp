#include "alcove/field/detail/bricks.h"
#include "alcove/grid/detail/clustered.h"
#include "alcove/grid/detail/plan.h"
#include "alcove/grid/detail/sign.h"

#include "alcove/base/parallel.h"
#include "alcove/base/types.h"
#include "alcove/field/level_stack.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/triangulate.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>

namespace alcove {
namespace {

/// A sphere of radius 10 around (11, 11, 11): 130,000 triangles, about a hundred per unit of area.
Mesh dense_sphere() {
    Mesh mesh;
    test::add_part(mesh, test::sphere_mesh(7), 10.0, Vec3d(11.0));
    return mesh;
}

Mesh noisy(Mesh mesh, double size) {
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0.0, size);
    for (Vec3d& p : mesh.positions)
        p += Vec3d(noise(random), noise(random), noise(random));
    return mesh;
}

ClusteredSurface clustered(const Surface& surface, double cell) {
    return {surface, balanced(surface.triangles), cell};
}

ClusteredSurface clustered(const Mesh& mesh, double cell) {
    return clustered({mesh.positions, triangulate(mesh).triangles}, cell);
}

TEST(ClusteredSurface, HasTheTrianglesThatCellsTell) {
    const Mesh mesh = dense_sphere();
    const ClusteredSurface reduced = clustered(mesh, 0.5);
    const auto count = static_cast<double>(reduced.surface().triangles.size()), area = 400.0 * std::numbers::pi;
    EXPECT_LT(count, 16.0 * area);
    EXPECT_GT(count, 8.0 * area);
    for (const Vec3d& p : reduced.surface().positions)
        EXPECT_NEAR(glm::length(p - Vec3d(11.0)), 10.0, 0.02); // the sagitta of an arc over a cell's diagonal
}

TEST(ClusteredSurface, IsTheSameWhereEveryVertexHasItsCell) {
    const Mesh mesh = test::box_mesh({8, 8, 8}, 8);
    Mesh moved;
    test::add_part(moved, mesh, 1.0, Vec3d(9.25));
    const std::vector<Triangle> triangles = triangulate(moved).triangles;
    const ClusteredSurface reduced = clustered(Surface{moved.positions, triangles}, 0.5);
    EXPECT_TRUE(std::ranges::equal(reduced.surface().positions, moved.positions));
    EXPECT_TRUE(std::ranges::equal(reduced.surface().triangles, triangles));
}

TEST(ClusteredSurface, OfAClosedOneIsClosed) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
    const ClusteredSurface reduced = clustered(dense_sphere(), 0.5);
    for (const Triangle& t : reduced.surface().triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            runs[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    EXPECT_TRUE(std::ranges::all_of(runs, [](const auto& run) { return run.second == 0; }));
}

TEST(ClusteredSurface, TurnsAsBefore) {
    double volume = 0.0;
    const ClusteredSurface reduced = clustered(noisy(dense_sphere(), 0.1), 0.5);
    for (const Triangle& t : reduced.surface().triangles) {
        const auto corner = [&](std::size_t k) { return reduced.surface().positions[t[k]] - Vec3d(11.0); };
        volume += glm::dot(corner(0), glm::cross(corner(1), corner(2))) / 6.0;
    }
    EXPECT_NEAR(volume, 4000.0 * std::numbers::pi / 3.0, 0.02 * 4000.0);
}

/// A copy in which no two triangles share a vertex.
Mesh unwelded(const Mesh& mesh) {
    Mesh soup;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const auto first = static_cast<std::uint32_t>(soup.positions.size());
        for (const std::uint32_t v : mesh.face(f))
            soup.positions.push_back(mesh.positions[v]);
        soup.add_face(std::array{first, first + 1, first + 2});
    }
    return soup;
}

TEST(ClusteredSurface, DoesNotOpenSeams) {
    const Mesh sphere = dense_sphere();
    const ClusteredSurface whole = clustered(sphere, 0.5), soup = clustered(unwelded(sphere), 0.5);
    EXPECT_EQ(soup.surface().triangles.size(), whole.surface().triangles.size());
    EXPECT_EQ(soup.surface().positions.size(), whole.surface().positions.size());
}

/// Many parts smaller than a cell.
Mesh dust(int along) {
    Mesh mesh;
    for (int i = 0; i < along; ++i)
        for (int j = 0; j < along; ++j)
            for (int k = 0; k < along; ++k)
                test::add_part(mesh, test::sphere_mesh(1), 0.01, Vec3d(1.25) + Vec3d(i, j, k));
    return mesh;
}

TEST(ClusteredSurface, KeepsPartsSmallerThanACell) {
    EXPECT_EQ(clustered(dust(3), 0.5).surface().triangles.size(), dust(3).face_count());
}

TEST(ClusteredSurface, KeepsStrutsThinnerThanACell) {
    // A triangular strut between two spheres: three sides of two triangles each, on vertices of the spheres.
    Mesh mesh = dense_sphere();
    const auto second = static_cast<std::uint32_t>(mesh.positions.size());
    test::add_part(mesh, test::sphere_mesh(7), 10.0, Vec3d(36.0, 11.0, 11.0));
    const auto& first_face = mesh.face(0);
    std::array<std::uint32_t, 3> here{};
    std::copy_n(first_face.begin(), 3, here.begin());
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = here[k], b = here[(k + 1) % 3];
        mesh.add_face(std::array{b, a, second + a});
        mesh.add_face(std::array{b, second + a, second + b});
    }
    const ClusteredSurface reduced = clustered(mesh, 0.5);
    EXPECT_EQ(std::ranges::count_if(reduced.surface().triangles,
                                    [&](const Triangle& t) {
                                        const std::span<const Vec3d> p = reduced.surface().positions;
                                        return glm::length(p[t[0]] - p[t[1]]) > 20.0 ||
                                               glm::length(p[t[1]] - p[t[2]]) > 20.0;
                                    }),
              6);
}

TEST(ClusteredSurface, KeepsTheSidesOfAThinWallApart) {
    Mesh mesh;
    for (const double z : {1.1, 1.3}) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        constexpr std::uint32_t n = 40;
        for (std::uint32_t i = 0; i <= n; ++i)
            for (std::uint32_t j = 0; j <= n; ++j)
                mesh.positions.emplace_back(1.0 + 0.05 * i, 1.0 + 0.05 * j, z);
        for (std::uint32_t i = 0; i < n; ++i)
            for (std::uint32_t j = 0; j < n; ++j) {
                const std::uint32_t at = first + i * (n + 1) + j;
                mesh.add_face(std::array{at, at + n + 1, at + n + 2, at + 1});
            }
    }
    const ClusteredSurface reduced = clustered(mesh, 0.5);
    EXPECT_LT(reduced.surface().triangles.size(), 200u);
    const auto at = [&](double z) {
        return std::ranges::count_if(reduced.surface().positions,
                                     [&](const Vec3d& p) { return std::fabs(p.z - z) < 1e-12; });
    };
    EXPECT_EQ(at(1.1), at(1.3));
    EXPECT_EQ(at(1.1) + at(1.3), static_cast<std::ptrdiff_t>(reduced.surface().positions.size()));
}

TEST(ClusteredSurface, VerticesOfNoTriangleTakeNoPart) {
    const Mesh mesh = dense_sphere();
    const std::vector<Triangle> triangles = triangulate(mesh).triangles;
    std::vector<Vec3d> more = mesh.positions;
    more.insert(more.end(), {more[0] + 0.01, Vec3d(NAN), Vec3d(INFINITY, 0, 0)});
    const ClusteredSurface reduced = clustered(Surface{mesh.positions, triangles}, 0.5),
                           with = clustered(Surface{more, triangles}, 0.5);
    EXPECT_TRUE(std::ranges::equal(with.surface().triangles, reduced.surface().triangles));
    EXPECT_TRUE(std::ranges::equal(with.surface().positions.first(reduced.surface().positions.size()),
                                   reduced.surface().positions));
}

TEST(ClusteredSurface, ThreadsDoNotMatter) {
    const auto with = [](unsigned threads) {
        const ThreadLimit limit(threads);
        return clustered(noisy(dense_sphere(), 0.1), 0.5);
    };
    const ClusteredSurface one = with(1), four = with(4);
    EXPECT_TRUE(std::ranges::equal(one.surface().positions, four.surface().positions));
    EXPECT_TRUE(std::ranges::equal(one.surface().triangles, four.surface().triangles));
}

GridStack stack_of(const Mesh& mesh, bool reduced, double memory_limit = GridOptions{}.memory_limit) {
    VoxelizeOptions options;
    options.grid = {.voxel = 1.0f / 32.0f, .inner_band = 5.0f, .cluster = reduced, .memory_limit = memory_limit};
    return voxelize(mesh, triangulate(mesh).triangles, options);
}

/// No point of the surface moves by more than two diagonals of a cell, so no distance changes by more.
TEST(ThinnedGrids, AreNearExactOnesAndOfTheSameSigns) {
    struct Case {
        Mesh mesh;
        double mean; ///< voxels
    };
    // The sagitta of an arc of radius 9 voxels over two cell diagonals; more for the noisy mesh.
    constexpr double sagitta = 12.0 * cluster_cell * cluster_cell / (8.0 * 9.0);
    const Mesh open = test::sphere_mesh(7, [](const Vec3d& p) { return p.y > 0.0; });
    for (const auto& [mesh, mean] :
         {Case{dense_sphere(), sagitta}, {noisy(dense_sphere(), 0.05), sagitta + 0.03}, {open, sagitta}}) {
        const GridStack exact = stack_of(mesh, false), reduced = stack_of(mesh, true);
        EXPECT_FALSE(exact.clustered);
        ASSERT_TRUE(reduced.clustered);
        EXPECT_EQ(reduced.sign, exact.sign);
        ASSERT_EQ(reduced.levels.size(), exact.levels.size());
        const Bricks field = LevelStack(reduced).levels().front(), expected = LevelStack(exact).levels().front();
        const float voxel = field.voxel(), limit = 4.0f * voxel;
        double sum = 0.0;
        std::size_t count = 0;
        for (Vec3 p(-0.5f); p.x < 0.5f; p.x += voxel)
            for (p.y = -0.5f; p.y < 0.5f; p.y += voxel)
                for (p.z = -0.5f; p.z < 0.5f; p.z += voxel) {
                    const Vec3 centre = field.origin() + voxel * glm::round((p - field.origin()) / voxel);
                    const float found = field.map(centre), correct = expected.map(centre);
                    if (std::fabs(correct) > limit)
                        continue;
                    const float error = std::fabs(std::fabs(found) - std::fabs(correct)) / voxel;
                    EXPECT_LE(error, 2.0 * std::sqrt(3.0) * cluster_cell);
                    if (exact.sign == Sign::solid) {
                        EXPECT_EQ(std::signbit(found), std::signbit(correct));
                    }
                    sum += error;
                    ++count;
                }
        EXPECT_GT(count, 4000u);
        EXPECT_LE(sum / static_cast<double>(count), mean);
    }
}

TEST(ThinnedGrids, AreExactWhereTrianglesAreFew) {
    Mesh mesh;
    test::add_part(mesh, test::sphere_mesh(5), 10.0, Vec3d(11.0));
    const GridStack exact = stack_of(mesh, false), reduced = stack_of(mesh, true);
    EXPECT_FALSE(reduced.clustered);
    EXPECT_EQ(reduced.levels.front().active_voxels, exact.levels.front().active_voxels);
}

TEST(ThinnedGrids, OfWhatCannotBeThinnedAreRefusedWhereAllDoNotFit) {
    const Mesh sphere = dense_sphere(), parts = dust(12);
    const auto limit = [](const Mesh& mesh) { return 200.0 * static_cast<double>(mesh.face_count()); };
    EXPECT_NO_THROW(stack_of(sphere, true, limit(sphere)));
    EXPECT_THROW(stack_of(sphere, false, limit(sphere)), LimitError);
    EXPECT_THROW(stack_of(parts, true, limit(parts)), LimitError);
    EXPECT_FALSE(stack_of(parts, true).clustered) << "all triangles are kept";
}

}
}
