#include "alcove/base/detail/duplicate_faces.h"

#include "alcove/field/level_stack.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/triangulate.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace alcove {
namespace {

TEST(Twins, OnlyTheFirstOfThoseOnTheSamePlacesStays) {
    const std::vector<Vec3d> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-0.0, 0, 0}, {1, 0, 0}};
    const std::vector<Triangle> triangles{{0, 1, 2}, {0, 1, 3}, {2, 1, 0}, {4, 5, 2}, {3, 5, 4}, {1, 2, 3}};
    const std::vector<Triangle> kept{{0, 1, 2}, {0, 1, 3}, {1, 2, 3}};
    EXPECT_EQ(without_duplicate_faces<Vec3d>(positions, triangles), kept);
    EXPECT_TRUE(without_duplicate_faces<Vec3d>(positions, {}).empty());
}

/// A thousand identical triangles, with vertices of their own and in all orientations, among a hundred thousand others.
TEST(Twins, ManyOfThemShowInASample) {
    std::vector<Vec3> positions;
    std::vector<Triangle> triangles;
    const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        positions.insert(positions.end(), {a, b, c});
        triangles.push_back({first, first + 1, first + 2});
    };
    for (int i = 0; i < 100'000; ++i)
        add(Vec3(i, 0, 0), Vec3(i, 1, 0), Vec3(i, 0, 1));
    EXPECT_FALSE(has_duplicates_in_sample(positions, triangles));
    EXPECT_EQ(without_duplicate_faces<Vec3>(positions, triangles), triangles);
    const std::size_t distinct = triangles.size();
    const std::array<Vec3, 3> corners{Vec3(0.5f, 0, 0), Vec3(1, 2, 0.25f), Vec3(-0.0f, 1, 3)};
    for (std::size_t i = 0; i < 1000; ++i)
        add(corners[i % 3], corners[(i + 1 + i % 2) % 3], corners[(i + 2 - i % 2) % 3]);
    EXPECT_TRUE(has_duplicates_in_sample(positions, triangles));
    EXPECT_EQ(without_duplicate_faces<Vec3>(positions, triangles).size(), distinct + 1);
}

/// A body with only double-sided faces has no inside: it equals the sheet of the first face of each pair.
TEST(Twins, OfAWholeMeshMakeNoDifferenceToItsSheet) {
    const Mesh sphere = test::sphere_mesh(3);
    Mesh both = sphere, backs;
    backs.positions = sphere.positions;
    for (std::size_t f = 0; f < sphere.face_count(); ++f)
        backs.add_face(std::array{sphere.face(f)[2], sphere.face(f)[1], sphere.face(f)[0]});
    test::add_part(both, backs, 1.0, Vec3d(0.0));
    const auto grids = [](const Mesh& mesh, SignChoice sign) {
        return voxelize(mesh, triangulate(mesh).triangles, {.grid = {}, .sign = sign});
    };
    const GridStack twice = grids(both, SignChoice::automatic), once = grids(sphere, SignChoice::sheet);
    ASSERT_EQ(twice.sign, Sign::sheet);
    const LevelStack of_twice(twice), of_once(once);
    for (int i = 0; i < 4000; ++i) {
        const Vec3 p(0.7f * std::sin(1.1f * i), 0.7f * std::sin(1.7f * i + 1.0f), 0.7f * std::sin(2.3f * i + 2.0f));
        ASSERT_EQ(of_twice.map(p), of_once.map(p));
    }
}

}
}
