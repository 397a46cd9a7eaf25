/// Which grids of a file are read, and how.
#include "grid_file.h"

#include "alcove/field/level_stack.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/triangulate.h"
#include "shapes.h"

#include <openvdb/io/Stream.h>

#include <cmath>
#include <fstream>

namespace alcove {
namespace {

using openvdb::DoubleGrid;
using openvdb::FloatGrid;
using test::GridFile;

class Selection : public GridFile {
  protected:
    Box box_of(const std::vector<std::string>& names = {}) {
        stack_ = read_grids(path("grids.vdb"), {names});
        return mesh_zero_surface(stack_).box();
    }
    GridStack stack_;
};

DoubleGrid::Ptr doubled(const FloatGrid::Ptr& grid) {
    const auto doubles = std::make_shared<DoubleGrid>(*grid);
    doubles->setGridClass(openvdb::GRID_LEVEL_SET);
    return doubles;
}

/// Doubles that were converted from floats are read as those floats, however they are stored.
TEST_F(Selection, DoublesAreReadAsFloatsAre) {
    const auto floats = ball("surface", 1.0f, {0, 0, 0});
    write_foreign(floats, "floats.vdb", 0);
    const GridStack expected = read_grids(path("floats.vdb"));
    for (const std::uint32_t compression : {0u, 1u, 2u, 3u, 4u, 6u}) {
        const auto doubles = doubled(floats);
        write_foreign(doubles, "doubles.vdb", compression);
        const GridStack stack = read_grids(path("doubles.vdb"));
        EXPECT_TRUE(stack.warnings.empty());
        EXPECT_EQ(stack.levels.front().active_voxels, expected.levels.front().active_voxels);
        const auto &a = *stack.levels.front().grid->grid, &b = *expected.levels.front().grid->grid;
        for (auto value = b.cbeginValueAll(); value; ++value)
            ASSERT_EQ(a.tree().getValue(value.getCoord()), *value);
        doubles->setSaveFloatAsHalf(true);
        write_foreign(doubles, "halves.vdb", compression);
        const Box box = mesh_zero_surface(read_grids(path("halves.vdb"))).box();
        EXPECT_NEAR(box.max.x, 1.0, 0.006) << compression;
    }
}

TEST_F(Selection, TruncatedDoublesAreFound) {
    for (const std::uint32_t compression : {0u, 1u, 2u, 4u, 6u}) {
        write_foreign(doubled(ball("surface", 1.0f, {0, 0, 0})), "whole.vdb", compression);
        std::ifstream in(path("whole.vdb"), std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(in), {}};
        for (std::size_t cut = 1; cut < 40; ++cut) {
            std::ofstream(path("cut.vdb"), std::ios::binary) << bytes.substr(0, bytes.size() * cut / 40);
            EXPECT_NE(refusal("cut.vdb"), "read") << compression << " " << cut;
        }
    }
}

TEST_F(Selection, AllLevelSetsAreReadUnlessSomeAreNamed) {
    write_grids_of({ball("left", 1.0f, {0, 0, 0}), ball("middle", 0.5f, {2, 0, 0}), ball("right", 1.0f, {4, 0, 0})});
    EXPECT_NEAR(box_of().max.x, 5.0, 0.01);
    EXPECT_NEAR(box_of().min.x, -1.0, 0.01);
    EXPECT_EQ(stack_.sources.size(), 3u);
    EXPECT_TRUE(stack_.warnings.empty());
    EXPECT_NEAR(box_of({"right"}).min.x, 3.0, 0.01);
    EXPECT_NEAR(box_of({"middle", "left"}).max.x, 2.5, 0.02);
    EXPECT_EQ(stack_.sources, (std::vector<std::string>{"left", "middle"}));
    EXPECT_NE(refusal("grids.vdb", {{"centre"}}).find("has no grid 'centre', but 'left' (float, level set), 'middle'"),
              std::string::npos)
        << refusal("grids.vdb", {{"centre"}});
}

TEST_F(Selection, GridsOfOneNameAreToldApart) {
    write_grids_of({ball("surface", 1.0f, {0, 0, 0}), ball("surface", 1.0f, {4, 0, 0})});
    EXPECT_NEAR(box_of({"surface"}).max.x, 5.0, 0.01);
    const std::vector<StoredGrid> grids = list_grids(path("grids.vdb"));
    ASSERT_EQ(grids.size(), 2u);
    EXPECT_NE(grids[0].name, grids[1].name);
    EXPECT_NEAR(box_of({grids[1].name}).min.x, 3.0, 0.01);
}

/// Copies of a grid share its tree in the file.
TEST_F(Selection, GridsMayShareATree) {
    const auto left = ball("left", 1.0f, {0, 0, 0});
    const FloatGrid::Ptr right = left->copy();
    right->setName("right");
    right->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
    right->transform().postTranslate({4, 0, 0});
    write_grids_of({left, right});
    EXPECT_NEAR(box_of().max.x, 5.0, 0.01);
    EXPECT_NEAR(box_of({"right"}).min.x, 3.0, 0.01);
}

/// Distances to a union of balls, on one lattice and on lattices that differ in size, position and orientation.
TEST_F(Selection, UnionsHoldDistancesToTheNearerSurface) {
    for (const bool same : {true, false}) {
        const auto a = ball("a", 1.0f, {0, 0, 0}), b = ball("b", 0.8f, {1.2f, 0, 0}, same ? 0.1f : 0.07f);
        if (!same)
            a->transform().postRotate(0.6, openvdb::math::Y_AXIS); // about its centre
        write_grids_of({a, b});
        const Mesh mesh = mesh_zero_surface(stack_ = read_grids(path("grids.vdb")));
        const auto exact = [](const Vec3d& p) {
            return std::min(glm::length(p) - 1.0, glm::length(p - Vec3d(1.2, 0, 0)) - 0.8);
        };
        for (const Vec3d& p : mesh.positions)
            ASSERT_NEAR(exact(p), 0.0, 0.03); // the seam is rounded
        const LevelStack field(stack_);
        for (const Vec3d& p : {Vec3d(-1.05, 0, 0), Vec3d(0, 0.95, 0), Vec3d(2.05, 0, 0), Vec3d(1.2, 0, 0.85),
                               Vec3d(0, -1.1, 0.05), Vec3d(0.9, 0, 0)})
            EXPECT_NEAR(std::max(field.map(stack_.frame.to_unit(p)) * stack_.frame.diagonal, -0.1),
                        std::max(exact(p), -0.1), 0.01)
                << same << p.x << " " << p.y << " " << p.z;
        EXPECT_TRUE(stack_.warnings.empty());
    }
}

TEST_F(Selection, FogIsPassedOver) {
    const auto fog = FloatGrid::create(0.0f);
    fog->fill({{0, 0, 0}, {20, 20, 20}}, 0.5f);
    fog->setName("density");
    fog->setGridClass(openvdb::GRID_FOG_VOLUME);
    const auto bad = fog->deepCopy();
    bad->setName("temperature");
    bad->tree().setValue({1, 1, 1}, NAN);
    write_grids_of({fog, bad, ball("surface", 2.0f, {0, 0, 0})});
    EXPECT_NEAR(box_of().max.x, 2.0, 0.01);
    EXPECT_EQ(stack_.sources, std::vector<std::string>{"surface"});
    EXPECT_TRUE(stack_.warnings.empty());
    const std::vector<StoredGrid> grids = list_grids(path("grids.vdb"));
    ASSERT_EQ(grids.size(), 3u);
    EXPECT_EQ(grids[0].name, "density");
    EXPECT_EQ(grids[0].grid_class, "fog volume");
    EXPECT_EQ(grids[0].active_voxels, 21 * 21 * 21);
    EXPECT_EQ(grids[2].type, "float");
    EXPECT_EQ(grids[2].grid_class, "level set");
    EXPECT_NE(refusal("grids.vdb", {{"density"}}).find("'density' is a fog volume, not a level set"),
              std::string::npos);
}

TEST_F(Selection, WhatIsUselessIsLeftOutWithAWarning) {
    const auto empty = FloatGrid::create(0.3f);
    empty->setName("empty");
    empty->setGridClass(openvdb::GRID_LEVEL_SET);
    const auto view = ball("view", 1.0f, {0, 0, 0});
    view->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(openvdb::Vec3d(-20), openvdb::Vec3d(20)), 0.5, 10.0, 0.1));
    const auto whole = openvdb::Int32Grid::create(3);
    whole->setName("whole");
    whole->setGridClass(openvdb::GRID_LEVEL_SET);
    write_grids_of({empty, view, whole, ball("surface", 1.0f, {0, 0, 0})});
    EXPECT_NEAR(box_of().max.x, 1.0, 0.01);
    ASSERT_EQ(stack_.warnings.size(), 3u);
    for (const char* part : {"'empty' is empty", "'view' is left out", "'whole' is left out: it is of type int32"})
        EXPECT_TRUE(std::any_of(stack_.warnings.begin(), stack_.warnings.end(), [&](const std::string& warning) {
            return warning.find(part) != std::string::npos;
        })) << part;
}

GridStack stack_of_ball(double radius, const Vec3d& center) {
    Mesh mesh;
    test::add_part(mesh, test::sphere_mesh(5), radius, center);
    VoxelizeOptions options;
    options.grid.lattice = Lattice{0.1};
    options.grid.radius = 0.3f;
    return voxelize(mesh, triangulate(mesh).triangles, options);
}

openvdb::GridPtrVec grids_of(const std::filesystem::path& file) {
    openvdb::io::File archive(file.string());
    archive.open(/*delayLoad=*/false);
    return *archive.getGrids();
}

/// All levels of a stack count as one grid, beside those of other stacks and programs.
TEST_F(Selection, StacksAreUnitedWithOthers) {
    write_grids(stack_of_ball(1.0, Vec3d(0.0)), path("a.vdb"));
    write_grids(stack_of_ball(1.0, Vec3d(4, 0, 0)), path("b.vdb"));
    ASSERT_GT(grids_of(path("a.vdb")).size(), 1u);
    openvdb::GridPtrVec all = grids_of(path("a.vdb"));
    for (const auto& grid : grids_of(path("b.vdb")))
        all.push_back(grid);
    write_grids_of(all);
    EXPECT_NEAR(box_of().max.x, 5.0, 0.02);
    EXPECT_NEAR(box_of().min.x, -1.0, 0.02);
    all.push_back(ball("foreign", 1.0f, {0, 4, 0}));
    write_grids_of(all);
    EXPECT_NEAR(box_of().max.y, 5.0, 0.02);
    EXPECT_NEAR(box_of().max.x, 5.0, 0.02);
    EXPECT_NEAR(box_of({"foreign"}).max.x, 1.0, 0.02);
    EXPECT_NEAR(box_of({"surface[1]"}).min.x, 3.0, 0.02);
    EXPECT_GT(stack_.levels.size(), 1u);
}

TEST_F(Selection, StreamsAreReadToo) {
    std::ofstream stream(path("grids.vdb"), std::ios::binary);
    openvdb::io::Stream(stream).write(
        openvdb::GridCPtrVec{ball("a", 1.0f, {0, 0, 0}), ball("b", 1.0f, {4, 0, 0}), doubled(ball("c", 1, {0, 4, 0}))});
    stream.close();
    EXPECT_NEAR(box_of().max.x, 5.0, 0.01);
    EXPECT_NEAR(box_of().max.y, 5.0, 0.01);
    EXPECT_NEAR(box_of({"b"}).min.x, 3.0, 0.01);
}

}
}
