#include "alcove/grid/voxelize.h"
#include "alcove/vdb/vdb_file.h"

#include "alcove/base/types.h"
#include "alcove/field/level_stack.h"
#include "alcove/grid/detail/vdb_grid.h"
#include "alcove/mesh/triangulate.h"
#include "grid_file.h"
#include "shapes.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/io/Stream.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>
#include <fstream>
#include <random>

namespace alcove {
namespace {

namespace io = openvdb::io;

using test::GridFile;

GridStack sphere_stack(double scale = 1.0, const Vec3d& move = Vec3d(0.0)) {
    Mesh mesh;
    test::add_part(mesh, test::sphere_mesh(5), scale, move);
    VoxelizeOptions options;
    options.grid.voxel = 1.0f / 64.0f;
    options.grid.radius = 0.2f;
    return voxelize(mesh, triangulate(mesh).triangles, options);
}

TEST_F(GridFile, AStackComesBackToTheBit) {
    const GridStack stack = sphere_stack(37.0, {1e4, -2e3, 5.5});
    write_grids(stack, path("stack.vdb"));
    const GridStack back = read_grids(path("stack.vdb"));
    ASSERT_EQ(back.levels.size(), stack.levels.size());
    EXPECT_EQ(back.sign, stack.sign);
    EXPECT_EQ(back.frame.diagonal, stack.frame.diagonal);
    EXPECT_EQ(back.frame.center, stack.frame.center);
    const LevelStack a(stack), b(back);
    std::mt19937 random(2);
    std::uniform_real_distribution<float> coordinate(-0.6f, 0.6f);
    for (std::size_t l = 0; l < stack.levels.size(); ++l) {
        EXPECT_EQ(back.levels[l].voxel, stack.levels[l].voxel);
        EXPECT_EQ(back.levels[l].origin, stack.levels[l].origin);
        EXPECT_EQ(back.levels[l].active_voxels, stack.levels[l].active_voxels);
    }
    for (int i = 0; i < 20000; ++i) {
        const Vec3 p(coordinate(random), coordinate(random), coordinate(random));
        EXPECT_EQ(a.map(p), b.map(p));
    }
}

TEST_F(GridFile, PartialLevelsComeBackToo) {
    Mesh mesh; // two spheres that nearly touch
    test::add_part(mesh, test::sphere_mesh(5), 10.0, {0, 0, 0});
    test::add_part(mesh, test::sphere_mesh(5), 10.0, {20.05, 0, 0});
    const GridStack stack = voxelize(mesh, triangulate(mesh).triangles, {.grid = {.radius = 0.05f}});
    ASSERT_EQ(stack.partial.size(), 2u);
    write_grids(stack, path("partial.vdb"));
    const GridStack back = read_grids(path("partial.vdb"));
    EXPECT_EQ(back.levels.size(), stack.levels.size());
    ASSERT_EQ(back.partial.size(), 2u);
    const LevelStack a(stack), b(back);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> coordinate(-2.0, 2.0);
    int changed = 0;
    GridStack whole = stack;
    whole.partial.clear();
    const LevelStack coarse(whole);
    for (int i = 0; i < 20000; ++i) {
        const Vec3 p = stack.frame.to_unit({10.0 + coordinate(random), coordinate(random), coordinate(random)});
        EXPECT_EQ(a.map(p), b.map(p));
        changed += a.map(p) != coarse.map(p);
    }
    EXPECT_GT(changed, 1000);
    std::vector<std::string> names;
    for (const StoredGrid& grid : list_grids(path("partial.vdb")))
        names.push_back(grid.name);
    for (const char* name : {"surface", "surface_fine_1", "surface_fine_2"})
        EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
}

TEST_F(GridFile, OthersFindLevelSetsInSceneUnits) {
    write_grids(sphere_stack(10.0, {100, 0, 0}), path("stack.vdb"));
    io::File file(path("stack.vdb").string());
    file.open();
    for (const char* name : {"surface", "surface_2", "surface_3"}) {
        const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(name));
        EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
        EXPECT_EQ(grid->getCreator(), "Alcove");
        const auto index = openvdb::Coord::round(grid->worldToIndex(openvdb::Vec3d(110, 0, 0)));
        const openvdb::Vec3d centre = grid->indexToWorld(index);
        EXPECT_NEAR(grid->tree().getValue(index), (centre - openvdb::Vec3d(100, 0, 0)).length() - 10.0,
                    0.03 * grid->voxelSize().x());
        EXPECT_LT(grid->tree().getValue(openvdb::Coord::round(grid->worldToIndex(openvdb::Vec3d(100, 0, 0)))), 0.0f);
    }
}

TEST_F(GridFile, ALevelSetOfAnotherProgramIsAField) {
    const auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(2.0f, {5, 6, 7}, 0.05f, 5.0f);
    write_foreign(sphere, "foreign.vdb", io::COMPRESS_ZIP);
    const GridStack stack = read_grids(path("foreign.vdb"));
    ASSERT_EQ(stack.levels.size(), 1u);
    const LevelStack field(stack);
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 1000; ++i) {
        const Vec3d out = glm::normalize(Vec3d(normal(random), normal(random), normal(random)));
        for (const double height : {-0.05, 0.0, 0.1, 0.19}) {
            const Vec3d p = Vec3d(5, 6, 7) + (2.0 + height) * out;
            EXPECT_NEAR(field.map(stack.frame.to_unit(p)) * stack.frame.diagonal, height, 0.05 * 0.05);
        }
    }
}

TEST_F(GridFile, DistancesInVoxelsAreTakenForWhatTheyAre) {
    const auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(2.0f, {5, 6, 7}, 0.05f, 5.0f);
    scale_values(*sphere, 1.0 / 0.05);
    write_foreign(sphere, "voxels.vdb", 0);
    const GridStack stack = read_grids(path("voxels.vdb"));
    ASSERT_EQ(stack.warnings.size(), 1u);
    EXPECT_NE(stack.warnings.front().find("change by 20 per unit"), std::string::npos) << stack.warnings.front();
    const LevelStack field(stack);
    EXPECT_NEAR(field.map(stack.frame.to_unit({7.1, 6, 7})) * stack.frame.diagonal, 0.1, 0.01);
    write_foreign(openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1.0f, {0, 0, 0}, 0.1f), "right.vdb", 0);
    EXPECT_TRUE(read_grids(path("right.vdb")).warnings.empty());
}

TEST_F(GridFile, ABandSetVoxelByVoxelHasAnInside) {
    // As a script would write it: voxels deep inside have the value of the outside.
    const auto band = openvdb::FloatGrid::create(0.15f);
    band->setTransform(openvdb::math::Transform::createLinearTransform(0.05));
    auto writer = band->getAccessor();
    for (int x = -30; x <= 30; ++x)
        for (int y = -30; y <= 30; ++y)
            for (int z = -30; z <= 30; ++z) {
                const float d = 0.05f * std::sqrt(static_cast<float>(x * x + y * y + z * z)) - 1.0f;
                if (std::fabs(d) < 0.15f)
                    writer.setValue({x, y, z}, d);
            }
    write_foreign(band, "script.vdb", 0);
    const GridStack stack = read_grids(path("script.vdb"));
    const LevelStack field(stack);
    for (const double x : {0.0, 0.3, 0.6, 0.8})
        EXPECT_LT(field.map(stack.frame.to_unit({x, 0.0, 0.0})), 0.0f) << x;
    EXPECT_GT(field.map(stack.frame.to_unit({1.3, 0.0, 0.0})), 0.0f);
    // Its faces point outward though the file does not say that it is a level set.
    const Mesh mesh = mesh_zero_surface(stack);
    const auto corners = mesh.face(0);
    const Vec3d &a = mesh.positions[corners[0]], &b = mesh.positions[corners[1]], &c = mesh.positions[corners[2]];
    EXPECT_GT(glm::dot(glm::cross(b - a, c - a), a), 0.0);
}

TEST_F(GridFile, TruncationIsFoundWhateverTheCompression) {
    for (const std::uint32_t compression : {0u, 1u, 2u, 3u, 4u, 6u}) {
        write_foreign(openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1.0f, {0, 0, 0}, 0.1f), "whole.vdb",
                      compression);
        std::ifstream in(path("whole.vdb"), std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(in), {}};
        for (int cut = 1; cut < 40; ++cut) {
            std::ofstream(path("cut.vdb"), std::ios::binary)
                << bytes.substr(0, bytes.size() * static_cast<std::size_t>(cut) / 40);
            EXPECT_NE(refusal("cut.vdb"), "read") << compression << " " << cut;
        }
        std::ofstream(path("cut.vdb"), std::ios::binary) << bytes.substr(0, bytes.size() - 1);
        EXPECT_NE(refusal("cut.vdb"), "read") << compression;
    }
}

/// OpenVDB reads the declared number of bytes into a buffer for the expected number.
TEST_F(GridFile, LengthsOfValuesAreNotBelieved) {
    for (const std::uint32_t compression : {1u, 4u, 6u}) {
        write_foreign(openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1.0f, {0, 0, 0}, 0.1f), "whole.vdb",
                      compression);
        ASSERT_EQ(refusal("whole.vdb"), "read");
        std::ifstream in(path("whole.vdb"), std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(in), {}};
        const std::int64_t too_long = -100000; // negative: uncompressed
        int refused = 0;
        for (std::size_t at = 500; at + 8 < bytes.size(); at += bytes.size() / 50) {
            std::string damaged = bytes;
            damaged.replace(at, 8, reinterpret_cast<const char*>(&too_long), 8);
            std::ofstream(path("damaged.vdb"), std::ios::binary) << damaged;
            refused += refusal("damaged.vdb") != "read";
        }
        EXPECT_GT(refused, 0) << compression; // and no buffer overflowed
    }
}

TEST_F(GridFile, WhatIsChangedBehindOurBackIsFound) {
    write_grids(sphere_stack(), path("stack.vdb"));
    io::File file(path("stack.vdb").string());
    file.open(/*delayLoad=*/false);
    const openvdb::GridPtrVec grids = *file.getGrids();
    file.close();
    ASSERT_EQ(grids.size(), 3u);

    io::File(path("fewer.vdb").string()).write(openvdb::GridPtrVec{grids[0], grids[2]});
    EXPECT_NE(refusal("fewer.vdb").find("2 of the 3 levels"), std::string::npos) << refusal("fewer.vdb");

    const auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(grids[1]);
    const auto voxel = floats->tree().cbeginLeaf()->cbeginValueOn().getCoord();
    const float value = floats->tree().getValue(voxel);
    floats->tree().setValueOnly(voxel, std::nextafter(value, 1.0f));
    write_foreign(floats, "edited.vdb", 0);
    EXPECT_NE(refusal("edited.vdb").find("its checksum"), std::string::npos);
    floats->tree().setValueOnly(voxel, value);

    floats->insertMeta("alcove:sign", openvdb::StringMetadata("sheet"));
    write_foreign(floats, "sheet.vdb", 0);
    EXPECT_NE(refusal("sheet.vdb").find("its checksum"), std::string::npos);

    // As written before there were checksums.
    for (const auto& grid : grids)
        for (const char* name : {"alcove:checksum", "alcove:levels"})
            grid->removeMeta(name);
    io::File(path("older.vdb").string()).write(grids);
    EXPECT_EQ(refusal("older.vdb"), "read");
}

TEST_F(GridFile, ValuesThatAreNoDistancesAreSaid) {
    const auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1.0f, {0, 0, 0}, 0.1f);
    const openvdb::Coord on_surface(10, 0, 0);
    sphere->tree().setValueOnly(on_surface, 0.2f);
    write_foreign(sphere, "bump.vdb", 0);
    const GridStack stack = read_grids(path("bump.vdb"));
    ASSERT_EQ(stack.warnings.size(), 1u);
    EXPECT_NE(stack.warnings.front().find("not distances"), std::string::npos) << stack.warnings.front();
    sphere->tree().setValueOnly(on_surface, 1e30f);
    write_foreign(sphere, "far.vdb", 0);
    EXPECT_NE(refusal("far.vdb").find("larger than the grid is wide"), std::string::npos);
}

TEST_F(GridFile, GridsOfOtherTypesArePassedOver) {
    const auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1.0f, {0, 0, 0}, 0.1f);
    const auto vectors = openvdb::Vec3SGrid::create();
    vectors->fill({{0, 0, 0}, {50, 50, 50}}, {1, 2, 3});
    vectors->setName("vectors");
    io::File(path("both.vdb").string()).write(openvdb::GridPtrVec{vectors, sphere});
    EXPECT_EQ(refusal("both.vdb"), "read");

    // A stream does not store where its grids end.
    const auto write_stream = [&](const openvdb::GridPtrVec& grids) {
        std::ofstream stream(path("stream.vdb"),
                             std::ios::binary); // OpenVDB leaves state in it, so use it only once
        io::Stream(stream).write(grids);
    };
    write_stream({vectors, sphere});
    EXPECT_NE(refusal("stream.vdb").find("write it as a file"), std::string::npos) << refusal("stream.vdb");
    write_stream({sphere, sphere->copy()}); // they share a tree
    EXPECT_EQ(refusal("stream.vdb"), "read");
}

TEST_F(GridFile, HalvedValuesAreRead) {
    const auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1.0f, {0, 0, 0}, 0.1f);
    sphere->setSaveFloatAsHalf(true);
    for (const std::uint32_t compression : {0u, 2u, 4u, 6u}) {
        write_foreign(sphere, "half.vdb", compression);
        EXPECT_EQ(refusal("half.vdb"), "read") << compression;
    }
}

TEST_F(GridFile, WhatIsNoLevelSetIsRefusedInWords) {
    std::ofstream(path("text.vdb")) << "this is no grid";
    EXPECT_NE(refusal("text.vdb").find("is not a .vdb file"), std::string::npos);
    EXPECT_NE(refusal("missing.vdb").find("cannot be opened"), std::string::npos);

    const auto fog = openvdb::FloatGrid::create(0.0f);
    fog->tree().setValue({0, 0, 0}, 1.0f);
    write_foreign(fog, "fog.vdb", 0);
    EXPECT_NE(refusal("fog.vdb").find("background of 0, but outside a level set distances are positive"),
              std::string::npos);
    fog->setGridClass(openvdb::GRID_FOG_VOLUME);
    fog->setName("density");
    write_foreign(fog, "fog.vdb", 0);
    EXPECT_NE(refusal("fog.vdb").find("no level set of floats or doubles, but 'density' (float, fog volume)"),
              std::string::npos);

    const auto unsigned_distances = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1.0f, {0, 0, 0}, 0.1f);
    for (auto value = unsigned_distances->beginValueAll(); value; ++value)
        value.setValue(std::fabs(*value));
    write_foreign(unsigned_distances, "unsigned.vdb", 0);
    EXPECT_NE(refusal("unsigned.vdb").find("no negative distance"), std::string::npos);

    const auto vectors = openvdb::Vec3SGrid::create();
    write_foreign(vectors, "vectors.vdb", 0);
    EXPECT_NE(refusal("vectors.vdb").find("no level set of floats or doubles"), std::string::npos);

    const auto nan = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1.0f, {0, 0, 0}, 0.1f);
    nan->tree().setValue({10, 0, 0}, NAN);
    write_foreign(nan, "nan.vdb", 0);
    EXPECT_NE(refusal("nan.vdb").find("not finite"), std::string::npos);
}

TEST_F(GridFile, AFailedWriteLeavesTheOldFile) {
    const GridStack stack = sphere_stack();
    write_grids(stack, path("old.vdb"));
    const auto size = std::filesystem::file_size(path("old.vdb"));
    EXPECT_THROW(write_grids(stack, path("no/such/folder.vdb")), IoError);
    EXPECT_EQ(std::filesystem::file_size(path("old.vdb")), size);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path("")), {}), 1);
}

}
}
