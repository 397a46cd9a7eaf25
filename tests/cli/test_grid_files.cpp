/// Level sets of other programs, and how they are named on the command line.
#include "baked.h"
#include "program.h"
#include "shapes.h"

#include "alcove/grid/detail/vdb_grid.h"
#include "alcove/mesh/files.h"

#include <openvdb/io/File.h>
#include <openvdb/tools/LevelSetPlatonic.h>
#include <openvdb/tools/LevelSetSphere.h>
#include <sys/stat.h>

#include <cmath>
#include <numbers>

namespace alcove::test {
namespace {

using openvdb::FloatGrid;

class GridFiles : public ProgramTest {
  protected:
    GridFiles() { openvdb::initialize(); }

    static FloatGrid::Ptr ball(const char* name, float radius, const openvdb::Vec3f& center) {
        const auto grid = openvdb::tools::createLevelSetSphere<FloatGrid>(radius, center, 0.1f);
        grid->setName(name);
        return grid;
    }
    void write_grids_to(const char* name, const openvdb::GridPtrVec& grids) const {
        openvdb::io::File((folder_ / "work" / name).string()).write(grids);
    }
    Box baked_box(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), {"bake", "-o", "a.ply", "--method", "classic"});
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, done) << outcome.err;
        return outcome.code == done ? read_baked(folder_ / "work/a.ply").mesh.box() : Box();
    }
};

TEST_F(GridFiles, ATurnedCubeIsBakedDrawnAndMeasuredInPlace) {
    const auto cube = openvdb::tools::createLevelSetCube<FloatGrid>(2.0f, openvdb::Vec3f(0.0f), 0.05f);
    cube->transform().postRotate(std::numbers::pi / 4, openvdb::math::Z_AXIS);
    write_grids_to("cube.vdb", {cube});
    const Box box = baked_box({"cube.vdb"});
    EXPECT_NEAR(box.max.x, std::numbers::sqrt2, 0.05);
    EXPECT_NEAR(box.min.y, -std::numbers::sqrt2, 0.05);
    EXPECT_NEAR(box.max.z, 1.0, 0.01);
    for (const float ao : read_baked(folder_ / "work/a.ply").ao)
        EXPECT_NEAR(ao, 1.0f, 0.02f);
    const Outcome drawn = run({"render", "cube.vdb", "-o", "cube.png", "--size", "160x90", "--json"});
    EXPECT_EQ(drawn.code, done) << drawn.err;
    EXPECT_EQ(drawn.err, "");
    EXPECT_GT(drawn.json().at("covered_pixels"), 1000);
    EXPECT_EQ(run({"measure", "cube.vdb", "--methods", "classic"}).code, done);
}

TEST_F(GridFiles, WhatIsDoneToAStretchedGridIsSaid) {
    const auto grid = ball("clay", 1.0f, {0, 0, 0});
    grid->transform().preScale(openvdb::Vec3d(1, 2, 1));
    write_grids_to("clay.vdb", {grid});
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"bake", "clay.vdb", "-o", "a.ply"}, {"render", "clay.vdb", "-o", "a.png"}}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, done);
        EXPECT_NE(outcome.err.find("grid 'clay' has voxels of 0.1 x 0.2 x 0.1, which are not cubes"), std::string::npos)
            << outcome.err;
    }
}

TEST_F(GridFiles, AllLevelSetsAreTakenOrThoseThatAreNamed) {
    const auto fog = FloatGrid::create(0.0f);
    fog->fill({{0, 0, 0}, {9, 9, 9}}, 0.5f);
    fog->setName("density");
    fog->setGridClass(openvdb::GRID_FOG_VOLUME);
    write_grids_to("two.vdb", {fog, ball("left", 1.0f, {0, 0, 0}), ball("right", 1.0f, {4, 0, 0})});
    EXPECT_NEAR(baked_box({"two.vdb"}).max.x, 5.0, 0.01);
    EXPECT_NEAR(baked_box({"two.vdb", "--grid-name", "right"}).min.x, 3.0, 0.01);
    EXPECT_NEAR(baked_box({"--grid-name", "left", "--grid-name", "right", "two.vdb"}).min.x, -1.0, 0.01);
    const auto covered = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"render", "two.vdb", "-o", "a.png", "--size", "160x90", "--json", "--no-ground",
                                   "--eye", "2,0,9", "--look-at", "2,0,0"});
        return run(more).json().at("covered_pixels").get<int>();
    };
    EXPECT_NEAR(covered({}), 2 * covered({"--grid-name", "left"}), 30);

    const Outcome info = run({"info", "two.vdb"});
    for (const char* part : {"'density': float, fog volume, 1,000 active, not used", "'left': float, level set",
                             "'right': float, level set"})
        EXPECT_NE(info.out.find(part), std::string::npos) << part << " is not in " << info.out;
    const nlohmann::json grids = run({"info", "two.vdb", "--json"}).json().at("grids");
    ASSERT_EQ(grids.size(), 3u);
    EXPECT_EQ(grids[0], nlohmann::json({{"name", "density"},
                                        {"type", "float"},
                                        {"class", "fog volume"},
                                        {"active_voxels", 1000},
                                        {"used", false}}));
    EXPECT_EQ(grids[2].at("used"), true);

    expect_refusal({"bake", "two.vdb", "-o", "a.ply", "--grid-name", "centre"}, bad_input,
                   {"two.vdb", "no grid 'centre'", "'left'", "'right'"});
    expect_refusal({"bake", "two.vdb", "-o", "a.ply", "--grid-name", "density"}, bad_input, {"'density'", "fog"});
    write("cube.off", cube_off);
    expect_refusal({"bake", "cube.off", "-o", "a.ply", "--grid-name", "left"}, usage, {"--grid-name is for grids"});
    expect_refusal({"render", "cube.off", "-o", "a.png", "--grid-name", "left"}, usage, {"--grid-name is for grids"});
    write("scene.toml", "[[object]]\nshape = \"vdb\"\nfile = \"two.vdb\"\ngrid = \"left\"\n");
    EXPECT_EQ(run({"render", "scene.toml", "-o", "a.png", "--size", "160x90"}).code, done);
}

TEST_F(GridFiles, ALatticeOfAnotherGridOrALengthIsMet) {
    Mesh still, moved;
    add_part(still, box_mesh({0.5, 0.5, 0.5}, 1), 1.0, {0.5, 0.5, 0.5});
    add_part(moved, box_mesh({0.5, 0.5, 0.5}, 1), 1.0, {0.83, 0.5, 0.5});
    write_mesh(still, folder_ / "work/a.ply");
    write_mesh(moved, folder_ / "work/b.ply");
    const Outcome a = run({"voxelize", "a.ply", "-o", "a.vdb", "--lattice", "0.1", "--json"});
    ASSERT_EQ(a.code, done) << a.err;
    EXPECT_EQ(a.json().at("levels").at(0).at("voxel"), 0.1);
    ASSERT_EQ(run({"voxelize", "b.ply", "-o", "b.vdb", "--lattice", "a.vdb"}).code, done);
    const auto finest = [&](const char* name) {
        openvdb::io::File file((folder_ / "work" / name).string());
        file.open(/*delayLoad=*/false);
        return openvdb::gridPtrCast<FloatGrid>(file.readGrid("surface"));
    };
    const auto first = finest("a.vdb"), second = finest("b.vdb");
    EXPECT_EQ(first->transform(), second->transform());
    EXPECT_EQ(first->voxelSize().x(), 0.1);
    EXPECT_NEAR(second->tree().getValue({0, 5, 5}), 0.33f, 1e-5f);
    EXPECT_EQ(run({"bake", "b.ply", "-o", "b_ao.ply", "--grid", "b.vdb"}).code, done);

    for (const char* wrong : {"1%", "2vx", "inf", "-1", "word"})
        expect_refusal({"voxelize", "a.ply", "-o", "a.vdb", "--lattice", wrong}, usage, {"--lattice", wrong});
    expect_refusal({"voxelize", "a.ply", "-o", "a.vdb", "--lattice", "0.1", "--voxel", "0.1"}, usage,
                   {"--lattice", "--voxel", "cannot be combined"});
    second->transform().postRotate(0.5);
    second->clearMetadata();
    second->setGridClass(openvdb::GRID_LEVEL_SET);
    write_grids_to("turned.vdb", {second});
    expect_refusal({"voxelize", "a.ply", "-o", "a.vdb", "--lattice", "turned.vdb"}, bad_input,
                   {"turned.vdb", "not cubes along the axes"});
    expect_refusal({"voxelize", "a.ply", "-o", "a.vdb", "--lattice", "none.vdb"}, bad_input, {"none.vdb"});
}

TEST_F(GridFiles, WhatIsNoFileIsRefusedAtOnce) {
    ASSERT_EQ(::mkfifo((folder_ / "work/pipe.vdb").c_str(), 0600), 0);
    std::filesystem::create_directory(folder_ / "work/folder.vdb");
    std::filesystem::create_symlink("/dev/zero", folder_ / "work/device.vdb");
    for (const char* name : {"pipe.vdb", "folder.vdb", "device.vdb"}) {
        expect_refusal({"info", name}, bad_input, {name});
        expect_refusal({"bake", name, "-o", "a.ply"}, bad_input, {name});
        expect_refusal({"render", name, "-o", "a.png"}, bad_input, {name});
    }
}

TEST_F(GridFiles, FewBytesMayNotTakeMuchMemory) {
    const auto grid = FloatGrid::create(3.0f);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    grid->tree().addTile(3, openvdb::Coord(0), -3.0f, true);
    write_grids_to("tile.vdb", {grid});
    max_memory_ = std::size_t{1} << 30;
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"info", "tile.vdb"},
          {"bake", "tile.vdb", "-o", "a.ply", "--method", "classic", "--no-pilot"},
          {"render", "tile.vdb", "-o", "a.png"}})
        expect_refusal(arguments, bad_input, {"tile.vdb", "active tile"});
    write_mesh(sphere_mesh(4), folder_ / "work/sphere.ply");
    ASSERT_EQ(run({"voxelize", "sphere.ply", "-o", "sphere.vdb"}).code, done);
    expect_refusal({"bake", "sphere.vdb", "-o", "a.ply", "--max-memory", "1MB", "--max-read", "1GB"}, bad_input,
                   {"sphere.vdb", "over the limit of 1 MB", "--max-memory"});
}

/// If memory runs out, the input is not at fault.
TEST_F(GridFiles, TooLittleMemoryIsNoBadInput) {
    write_mesh(sphere_mesh(7), folder_ / "work/sphere.ply");
    int refused = 0;
    for (const std::size_t megabytes : {160, 180, 200, 220, 240, 260, 280, 300}) {
        max_memory_ = megabytes << 20;
        const Outcome outcome =
            run({"bake", "sphere.ply", "-o", "a.ply", "--method", "exact", "--rays", "1", "--threads", "1"});
        if (outcome.code == done)
            break;
        ++refused;
        EXPECT_EQ(outcome.code, failure) << megabytes << ": " << outcome.err;
    }
    EXPECT_GT(refused, 0);
}

}
}
