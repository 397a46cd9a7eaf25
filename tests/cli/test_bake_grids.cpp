#include "baked.h"
#include "program.h"
#include "shapes.h"

#include "alcove/grid/voxelize.h"
#include "alcove/mesh/detail/parts.h"
#include "alcove/mesh/files.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/vdb/vdb_file.h"

#include <algorithm>

namespace alcove::test {
namespace {

class BakeGrids : public ProgramTest {
  protected:
    /// A sphere of radius 2 around (5, 6, 7), as a mesh and as a level set for the given radius of occlusion.
    void write_sphere(float voxel, float radius) const {
        Mesh mesh;
        add_part(mesh, sphere_mesh(4), 2.0, center_);
        write_mesh(mesh, folder_ / "work/sphere.ply");
        const GridOptions grid{.radius = radius, .voxel = voxel};
        write_grids(voxelize(mesh, triangulate(mesh).triangles, {.grid = grid}), folder_ / "work/sphere.vdb");
    }
    const Vec3d center_{5, 6, 7};
};

TEST_F(BakeGrids, AGridIsMeshedAtItsZeroSurfaceAndBaked) {
    write_sphere(1.0f / 90.0f, 0.5f);
    for (const char* method : {"traced", "classic"}) {
        const Outcome outcome = run({"bake", "sphere.vdb", "-o", "a.ply", "--method", method, "--json"});
        ASSERT_EQ(outcome.code, done) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        const Baked baked = read_baked(folder_ / "work/a.ply");
        ASSERT_GT(baked.ao.size(), 1000u);
        for (const float ao : baked.ao)
            EXPECT_NEAR(ao, 1.0f, 0.01f);
        // The diagonal is that of the bounding box of the vertices.
        EXPECT_NEAR(outcome.json().at("radius").get<double>(), 0.1 * baked.mesh.box().diagonal(), 1e-5);
        for (std::size_t f = 0; f < baked.mesh.face_count(); ++f)
            ASSERT_EQ(baked.mesh.face(f).size(), 4u);
    }
    ASSERT_EQ(run({"bake", "sphere.vdb", "-o", "b.ply", "--adaptivity", "0.5"}).code, done);
    EXPECT_LT(read_mesh(folder_ / "work/b.ply").face_count(), read_mesh(folder_ / "work/a.ply").face_count() / 4);
}

TEST_F(BakeGrids, AThinBandIsExtendedWithAWarning) {
    write_sphere(1.0f / 90.0f, 0.02f);
    const Outcome outcome = run({"bake", "sphere.vdb", "-o", "a.ply", "--radius", "100%", "--method", "classic"});
    ASSERT_EQ(outcome.code, done) << outcome.err;
    EXPECT_NE(outcome.err.find("the grid stores distances only up to"), std::string::npos) << outcome.err;
    for (const float ao : read_baked(folder_ / "work/a.ply").ao)
        EXPECT_NEAR(ao, 1.0f, 0.01f);
}

TEST_F(BakeGrids, ASavedGridGivesTheBytesOfTheBakeThatSavedIt) {
    for (const auto& [name, method] : {std::pair("elephant.off", "traced"), std::pair("fandisk.off", "classic")}) {
        const std::vector<std::string> common{"bake", real_mesh(name), "--method", method};
        const auto with = [&](std::vector<std::string> more) {
            more.insert(more.begin(), common.begin(), common.end());
            return run(more);
        };
        ASSERT_EQ(with({"-o", "a.ply", "--write-grid", "g.vdb"}).code, done);
        const Outcome outcome = with({"-o", "b.ply", "--grid", "g.vdb"});
        ASSERT_EQ(outcome.code, done) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        EXPECT_EQ(bytes_of("b.ply"), bytes_of("a.ply")) << name;
    }
}

TEST_F(BakeGrids, ADenseMeshIsThinnedUnlessItsGridIsKept) {
    write_mesh(sphere_mesh(6), folder_ / "work/sphere.ply");
    const auto bake = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"bake", "sphere.ply", "-o", "a.ply"});
        const Outcome outcome = run(more);
        EXPECT_EQ(outcome.code, done) << outcome.err;
        return outcome;
    };
    EXPECT_TRUE(bake({"--voxel", "5%", "--json"}).json().at("clustered").get<bool>());
    EXPECT_NE(bake({"--voxel", "5%"}).out.find(", vertices within half a voxel clustered"), std::string::npos);
    for (const float ao : read_baked(folder_ / "work/a.ply").ao)
        EXPECT_NEAR(ao, 1.0f, 0.01f);
    EXPECT_FALSE(bake({"--voxel", "5%", "--json", "--write-grid", "g.vdb"}).json().at("clustered").get<bool>());
    EXPECT_FALSE(bake({"--json", "--voxel", "0.5%"}).json().at("clustered").get<bool>());
}

TEST_F(BakeGrids, AGridOfAnotherFrameServesItsMesh) {
    // Uses the grid of the whole sphere for one half of it: the bounding boxes, and so the diagonals, differ.
    write_sphere(1.0f / 200.0f, 0.2f);
    Mesh half;
    add_part(half, sphere_mesh(4, [](const Vec3d& p) { return p.y > 0.0; }), 2.0, center_);
    write_mesh(split_parts(half).front().mesh, folder_ / "work/half.ply");
    const Outcome outcome = run({"bake", "half.ply", "-o", "a.ply", "--grid", "sphere.vdb"});
    ASSERT_EQ(outcome.code, done) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    for (const float ao : read_baked(folder_ / "work/a.ply").ao)
        EXPECT_NEAR(ao, 1.0f, 0.01f);
}

TEST_F(BakeGrids, TheGridOfAnotherMeshIsNoticed) {
    write_sphere(1.0f / 90.0f, 0.2f);
    write("cube.off", cube_off);
    expect_refusal({"bake", "cube.off", "-o", "a.ply", "--grid", "sphere.vdb"}, bad_input,
                   {"cube.off", "8 of 8 vertices are more than two voxels off", "give the grid of this mesh"});
    // A few vertices may have moved, and vertices without faces may be anywhere.
    Mesh mesh;
    add_part(mesh, sphere_mesh(4), 2.0, center_);
    const std::size_t count = mesh.vertex_count();
    for (std::size_t v = 0; v < count / 4; ++v)
        mesh.positions[v] += Vec3d(0, 0, 1);
    for (std::size_t v = 0; v < 2 * count; ++v)
        mesh.positions.emplace_back(5, 6, 7);
    write_mesh(mesh, folder_ / "work/bent.ply");
    const Outcome outcome = run({"bake", "bent.ply", "-o", "a.ply", "--grid", "sphere.vdb"});
    EXPECT_EQ(outcome.code, done) << outcome.err;
    EXPECT_NE(outcome.err.find(" vertices are more than two voxels off the surface of the grid: is it"),
              std::string::npos)
        << outcome.err;
}

TEST_F(BakeGrids, RefusesWhatCannotBeMeant) {
    write("cube.off", cube_off);
    const auto refused = [&](std::vector<std::string> more, std::vector<std::string> parts) {
        more.insert(more.begin(), {"bake"});
        more.insert(more.end(), {"-o", "a.ply"});
        expect_refusal(more, usage, parts);
    };
    refused({"none.vdb", "--grid", "other.vdb"}, {"--grid is for meshes"});
    refused({"none.vdb", "--voxel", "1%"}, {"--voxel", "grid already"});
    refused({"none.ply", "--grid", "g.vdb", "--sign", "solid"}, {"--sign", "grid already"});
    refused({"none.vdb", "--self"}, {"--self", "grid"});
    refused({"none.ply", "--adaptivity", "0.5"}, {"--adaptivity is for grids"});
    refused({"none.vdb", "--adaptivity", "2"}, {"--adaptivity", "2"});
    expect_refusal({"bake", "none.vdb", "-o", "a.ply"}, bad_input, {"none.vdb", "cannot be opened"});
    expect_refusal({"bake", "cube.off", "-o", "a.ply", "--grid", "cube.off"}, bad_input, {"is not a .vdb file"});

    write_mesh(floor_mesh(1.0, 4), folder_ / "work/floor.ply");
    ASSERT_EQ(run({"voxelize", "floor.ply", "-o", "floor.vdb"}).code, done);
    expect_refusal({"bake", "floor.vdb", "-o", "a.ply"}, bad_input, {"floor.vdb", "open surface as a sheet"});
    EXPECT_EQ(files(), (std::vector<std::string>{"cube.off", "floor.ply", "floor.vdb"}));
}

}
}
