#include "alcove/grid/voxelize.h"

#include "alcove/mesh/triangulate.h"
#include "mesh/solids.h"

#include <fmt/ranges.h>
#include <gtest/gtest.h>

namespace alcove {
namespace {

GridStack grid_of(const Mesh& mesh) {
    VoxelizeOptions options;
    options.grid.voxel = 1.0f / 64.0f;
    options.grid.radius = 0.1f;
    return voxelize(mesh, triangulate(mesh).triangles, options);
}

void expect_silent_solid(const Mesh& mesh) {
    const GridStack stack = grid_of(mesh);
    EXPECT_EQ(stack.sign, Sign::solid);
    EXPECT_TRUE(stack.warnings.empty()) << fmt::format("{}", fmt::join(stack.warnings, "\n"));
}

void expect_sheet_and(const Mesh& mesh, const std::string& warning) {
    const GridStack stack = grid_of(mesh);
    EXPECT_EQ(stack.sign, Sign::sheet);
    ASSERT_EQ(stack.warnings.size(), 1u);
    EXPECT_NE(stack.warnings[0].find(warning), std::string::npos) << stack.warnings[0];
}

TEST(Solidity, ClosedMeshesAreSolids) {
    expect_silent_solid(cube());
    expect_silent_solid(torus(24, 12));
}

TEST(Solidity, VerticesKeptApartCloseAsWell) {
    expect_silent_solid(split(cube()));
}

TEST(Solidity, TheWallOfACavityIsNoMistake) {
    expect_silent_solid(together(cube({0, 0, 0}, 3.0), inverted(cube({1, 1, 1}, 1.0))));
}

TEST(Solidity, OpenMeshesAreSheets) {
    Mesh open = cube();
    std::vector<Face> faces = faces_of(open);
    faces.pop_back();
    const GridStack stack = grid_of(with_faces(open, faces));
    EXPECT_EQ(stack.sign, Sign::sheet);
    EXPECT_TRUE(stack.warnings.empty());
}

TEST(Solidity, ShellsInShellsAreSheets) {
    EXPECT_EQ(grid_of(together(cube({0, 0, 0}, 3.0), cube({1, 1, 1}, 1.0))).sign, Sign::sheet);
}

TEST(Solidity, CrossingPartsAreOneSolid) {
    expect_silent_solid(together(cube({0, 0, 0}, 2.0), cube({1.01, 1.01, 1.01}, 2.0)));
    const GridStack stack = grid_of(together(cube({0, 0, 0}, 2.0), inverted(cube({1.01, 1.01, 1.01}, 2.0))));
    ASSERT_EQ(stack.warnings.size(), 1u);
    EXPECT_NE(stack.warnings[0].find("1 of 2 parts faces inward, so its AO"), std::string::npos) << stack.warnings[0];
}

/// The cube in the middle is buried, but belongs to the whole, because it shares its vertices with its neighbours.
TEST(Solidity, CubesThatTouchAreOneSolid) {
    Mesh cubes;
    for (int i = 0; i < 27; ++i) {
        const Mesh next = cube({i / 9, i / 3 % 3, i % 3}, 1.0);
        cubes = i == 0 ? next : together(cubes, next);
    }
    expect_silent_solid(cubes);
}

TEST(Solidity, FacesThatTurnTheWrongWayAreTold) {
    std::vector<Face> faces = faces_of(cube());
    std::reverse(faces[2].begin(), faces[2].end());
    expect_sheet_and(with_faces(cube(), faces), "at 4 edges the neighbouring faces have opposite orientations");
    expect_sheet_and(inverted(cube()), "1 of 1 parts faces inward");
}

/// No column through a voxel centre hits the tiny part, but its edges do not cancel.
TEST(Solidity, ATinyPartThatIsOpenMakesASheet) {
    Mesh dust = cube({1.001, 0.501, 0.501}, 0.0001);
    std::vector<Face> faces = faces_of(dust);
    faces.pop_back();
    EXPECT_EQ(grid_of(together(cube(), with_faces(dust, faces))).sign, Sign::sheet);
}

/// A prism over a figure eight: its halves have winding numbers of 1 and −1, so a solid would lose one of them.
TEST(Solidity, SurfacesThatCrossThemselvesAndEncloseRegionsFromTheBackAreSheets) {
    const std::vector<Vec3d> loop{{-1, -1, 0}, {0, 0, 0}, {1, 1, 0}, {1, -1, 0}, {0, 0, 0}, {-1, 1, 0}};
    Mesh eight;
    for (const double z : {0.0, 1.0})
        for (const Vec3d& p : loop)
            eight.positions.push_back(p + Vec3d(0, 0, z));
    for (std::uint32_t i = 0; i < 6; ++i) {
        const std::uint32_t j = (i + 1) % 6;
        eight.add_face(std::vector<std::uint32_t>{i, j, j + 6, i + 6});
    }
    for (const Triangle& cap : {Triangle{0, 5, 1}, {2, 4, 3}, {6, 7, 11}, {8, 9, 10}})
        eight.add_face(cap);
    for (const Mesh& mesh : {eight, inverted(eight)}) {
        EXPECT_EQ(grid_of(mesh).sign, Sign::sheet);
        EXPECT_EQ(sign_of(mesh, triangulate(mesh).triangles), Sign::sheet);
    }
    EXPECT_EQ(sign_of(cube(), triangulate(cube()).triangles), Sign::solid);
}

}
}
