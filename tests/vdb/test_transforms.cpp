/// Level sets of any linear transform lie where their transform puts them, and their values are distances.
#include "grid_file.h"

#include "alcove/field/level_stack.h"
#include "alcove/grid/voxelize.h"

#include <fmt/format.h>
#include <openvdb/tools/Clip.h>
#include <openvdb/tools/LevelSetPlatonic.h>

#include <cmath>
#include <numbers>

namespace alcove {
namespace {

using openvdb::FloatGrid;
using openvdb::Vec3d;
using test::GridFile;
using Point = alcove::Vec3d;

constexpr double pi = std::numbers::pi;

class Transforms : public GridFile {
  protected:
    /// The zero surface of the grids, with its volume, which is positive if faces point outward.
    Mesh surface_of(const openvdb::GridPtrVec& grids) {
        stack_ = read_grids(write_grids_of(grids));
        Mesh mesh = mesh_zero_surface(stack_);
        volume_ = 0.0;
        const Point center = mesh.box().center();
        for (std::size_t f = 0; f < mesh.face_count(); ++f) {
            const auto face = mesh.face(f);
            for (std::size_t c = 2; c < face.size(); ++c)
                volume_ += glm::dot(mesh.positions[face[0]] - center, glm::cross(mesh.positions[face[c - 1]] - center,
                                                                                 mesh.positions[face[c]] - center)) /
                           6.0;
        }
        return mesh;
    }
    /// Expects a distance from the surface at a point, scene units.
    void expect_distance(const Point& at, double distance, double tolerance) const {
        const LevelStack field(stack_);
        EXPECT_NEAR(field.map(stack_.frame.to_unit(at)) * stack_.frame.diagonal, distance, tolerance)
            << at.x << " " << at.y << " " << at.z;
    }
    void expect_ball(const openvdb::GridPtrVec& grids, const Point& center, double radius, double tolerance) {
        const Mesh mesh = surface_of(grids);
        for (const Point& p : mesh.positions)
            ASSERT_NEAR(glm::length(p - center), radius, tolerance);
        EXPECT_NEAR(volume_, 4.0 / 3.0 * pi * std::pow(radius, 3), 0.03 * std::pow(radius, 3));
        const double out = 0.1 * radius;
        for (const Point& direction : {Point(1, 0, 0), Point(0, -1, 0), Point(0.6, 0, 0.8)}) {
            expect_distance(center + (radius + out) * direction, out, 2.0 * tolerance);
            expect_distance(center + (radius - out) * direction, -out, 2.0 * tolerance);
        }
    }

    GridStack stack_;
    double volume_ = 0.0;
};

/// A cube of half edge 1, turned by 45 degrees about z, reaches to √2 in x and y.
TEST_F(Transforms, ATurnedCubeReachesAsFarAsItsEdges) {
    constexpr double voxel = 0.05;
    const auto cube = openvdb::tools::createLevelSetCube<FloatGrid>(2.0f, openvdb::Vec3f(0.0f), float(voxel));
    cube->transform().postRotate(pi / 4, openvdb::math::Z_AXIS);
    const Box box = surface_of({cube}).box();
    EXPECT_NEAR(box.max.x, std::numbers::sqrt2, voxel);
    EXPECT_NEAR(box.min.y, -std::numbers::sqrt2, voxel);
    EXPECT_NEAR(box.max.z, 1.0, 0.1 * voxel);
    EXPECT_NEAR(volume_, 8.0, 0.05);
    EXPECT_TRUE(stack_.warnings.empty());
    EXPECT_NEAR(stack_.scene_voxel(), voxel, 1e-7);
    const Point face(std::sqrt(0.5), std::sqrt(0.5), 0.0); // the centre of a face, and its normal
    for (const double height : {-0.04, 0.0, 0.06})
        expect_distance((1.0 + height) * face, height, 0.002);
}

/// If the voxels of the lattice coincide with those of a grid, the values are copied.
TEST_F(Transforms, QuarterTurnsAndMirrorsKeepValues) {
    const auto plain = ball("plain", 1.0f, {0.3f, 0.1f, 0.2f}, 0.05f);
    const auto turned = plain->deepCopy(), mirrored = plain->deepCopy(), inverted = plain->deepCopy();
    turned->transform().postRotate(pi / 2, openvdb::math::X_AXIS);
    turned->transform().postTranslate({0, 0, 5});
    mirrored->transform().postScale(Vec3d(-1, 1, 1));
    inverted->transform().postScale(Vec3d(-1, -1, -1));
    constexpr double tolerance = 0.006; // the mesh of the plain ball is as far off
    expect_ball({plain}, {0.3, 0.1, 0.2}, 1.0, tolerance);
    const std::size_t active = stack_.levels.front().active_voxels;
    const auto expect_same = [&](const FloatGrid::Ptr& grid, const Point& center) {
        expect_ball({grid}, center, 1.0, tolerance);
        EXPECT_TRUE(stack_.warnings.empty());
        EXPECT_EQ(stack_.levels.front().active_voxels, active);
        EXPECT_NEAR(stack_.levels.front().outer_band, 3.0f, 1e-4f);
    };
    const Vec3d center = turned->indexToWorld(Vec3d(6, 2, 4));
    EXPECT_NEAR(center.z(), 5.0 + (center.y() < 0.0 ? 0.1 : -0.1), 1e-6);
    expect_same(turned, {center.x(), center.y(), center.z()});
    expect_same(mirrored, {-0.3, 0.1, 0.2});
    expect_same(inverted, {-0.3, -0.1, -0.2});
}

TEST_F(Transforms, TurnsScalesAndMirrorsMayBeCombined) {
    const auto grid = ball("ball", 1.0f, {0.3f, 0, 0}, 0.05f);
    grid->transform().postScale(Vec3d(2.5, -2.5, 2.5));
    scale_values(*grid, 2.5);
    grid->transform().postRotate(0.4, openvdb::math::Y_AXIS);
    grid->transform().postRotate(1.1, openvdb::math::X_AXIS);
    grid->transform().postTranslate({100, -50, 7});
    const Vec3d center = grid->indexToWorld(Vec3d(6, 0, 0));
    expect_ball({grid}, {center.x(), center.y(), center.z()}, 2.5, 0.01);
    EXPECT_TRUE(stack_.warnings.empty());
}

/// A ball that is stretched by 2 along y becomes an ellipsoid, and its values are recomputed as distances.
TEST_F(Transforms, StretchedVoxelsBecomeCubes) {
    const auto grid = ball("clay", 1.0f, {0, 0, 0}, 0.05f);
    grid->transform().preScale(Vec3d(1, 2, 1));
    const Mesh mesh = surface_of({grid});
    for (const Point& p : mesh.positions)
        ASSERT_NEAR(glm::length(p * Point(1, 0.5, 1)), 1.0, 0.01);
    EXPECT_NEAR(volume_, 8.0 / 3.0 * pi, 0.05);
    EXPECT_NEAR(stack_.scene_voxel(), 0.05, 1e-7);
    ASSERT_EQ(stack_.warnings.size(), 1u);
    EXPECT_NE(stack_.warnings.front().find("'clay' has voxels of 0.05 x 0.1 x 0.05, which are not cubes"),
              std::string::npos)
        << stack_.warnings.front();
    expect_distance({1.1, 0, 0}, 0.1, 0.003);
    expect_distance({0, 2.1, 0}, 0.1, 0.003);
    expect_distance({0, 1.9, 0}, -0.1, 0.006);
}

TEST_F(Transforms, ShearedVoxelsBecomeCubes) {
    const auto grid = ball("sheared", 1.0f, {0, 0, 0}, 0.05f);
    grid->transform().postShear(0.5, openvdb::math::X_AXIS, openvdb::math::Y_AXIS);
    const Mesh mesh = surface_of({grid});
    EXPECT_NEAR(volume_, 4.0 / 3.0 * pi, 0.03);
    for (const Point& p : mesh.positions) {
        const Vec3d index = grid->worldToIndex({p.x, p.y, p.z});
        ASSERT_NEAR(0.05 * index.length(), 1.0, 0.01);
    }
    EXPECT_EQ(stack_.warnings.size(), 1u);
}

TEST_F(Transforms, ThinBandsAreWidenedWhereTheyAreTurned) {
    const auto grid = ball("thin", 1.0f, {0, 0, 0}, 0.05f, 1.5f);
    grid->transform().postRotate(0.5, openvdb::math::Z_AXIS);
    expect_ball({grid}, {0, 0, 0}, 1.0, 0.006);
    ASSERT_EQ(stack_.warnings.size(), 1u);
    EXPECT_NE(stack_.warnings.front().find("band of only 1.5 voxels"), std::string::npos) << stack_.warnings.front();
}

/// The position of a grid costs no precision.
TEST_F(Transforms, FarFromTheOrigin) {
    const auto grid = ball("far", 1.0f, {0, 0, 0}, 0.05f);
    grid->transform().postTranslate({1e6, -2e6, 3e6});
    expect_ball({grid}, {1e6, -2e6, 3e6}, 1.0, 0.006);
    grid->transform().postRotate(0.3, openvdb::math::Z_AXIS);
    const Vec3d center = grid->indexToWorld(Vec3d(0));
    expect_ball({grid}, {center.x(), center.y(), center.z()}, 1.0, 0.006);
    // Far in index space.
    const auto near = ball("near", 1.0f, {0, 0, 0}, 0.05f), shifted = FloatGrid::create(0.15f);
    shifted->setGridClass(openvdb::GRID_LEVEL_SET);
    shifted->setTransform(openvdb::math::Transform::createLinearTransform(0.05));
    const openvdb::Coord far(20'000'000, 0, -40'000'000);
    for (auto value = near->cbeginValueOn(); value; ++value)
        shifted->tree().setValue(value.getCoord() + far, *value);
    expect_ball({shifted}, {1e6, 0, -2e6}, 1.0, 0.006);
}

TEST_F(Transforms, ACutSurfaceIsTurnedButNotStretched) {
    const auto cut = openvdb::tools::clip(*ball("cut", 1.0f, {0, 0, 0}), openvdb::BBoxd(Vec3d(-2), Vec3d(2, 2, 0.3)));
    cut->setGridClass(openvdb::GRID_LEVEL_SET);
    cut->transform().postRotate(0.5, openvdb::math::Z_AXIS);
    write_foreign(cut, "turned.vdb", 0);
    EXPECT_EQ(refusal("turned.vdb"), "read");
    cut->transform().preScale(Vec3d(1, 2, 1));
    write_foreign(cut, "stretched.vdb", 0);
    EXPECT_NE(refusal("stretched.vdb").find("'cut' cannot be voxelized again, because its surface is open"),
              std::string::npos)
        << refusal("stretched.vdb");
}

TEST_F(Transforms, FrustumsAreRefusedByName) {
    const auto grid = ball("view", 1.0f, {0, 0, 0});
    grid->setTransform(
        openvdb::math::Transform::createFrustumTransform(openvdb::BBoxd(Vec3d(-20), Vec3d(20)), 0.5, 10.0, 0.1));
    write_foreign(grid, "frustum.vdb", 0);
    EXPECT_NE(refusal("frustum.vdb").find("'view' is left out: it has a frustum transform"), std::string::npos)
        << refusal("frustum.vdb");
}

/// The memory of a large rotated grid is estimated before the grid is made.
TEST_F(Transforms, WhatDoesNotFitIsRefused) {
    const auto grid = ball("ball", 1.0f, {0, 0, 0}, 0.05f);
    const auto fine = ball("fine", 0.01f, {2, 0, 0}, 0.0005f);
    openvdb::io::File(path("two.vdb").string()).write(openvdb::GridPtrVec{grid, fine});
    GridSelection selection;
    selection.memory_limit = 1e8;
    EXPECT_NE(refusal("two.vdb", selection).find("limit: "), std::string::npos) << refusal("two.vdb", selection);
    EXPECT_NE(refusal("two.vdb", selection).find("--grid-name"), std::string::npos);
}

}
}
