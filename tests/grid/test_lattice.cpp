/// Grids on one lattice can be combined voxel by voxel, whatever the positions and sizes of their meshes.
#include "alcove/field/level_stack.h"
#include "alcove/grid/detail/vdb_grid.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/vdb/vdb_file.h"
#include "scratch_folder.h"
#include "shapes.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/tools/Composite.h>

#include <algorithm>
#include <filesystem>

namespace alcove {
namespace {

using openvdb::FloatGrid;

constexpr Lattice tenths{0.1};

Mesh box_at(const Vec3d& low, const Vec3d& size) {
    Mesh mesh;
    test::add_part(mesh, test::box_mesh(0.5 * size, 1), 1.0, low + 0.5 * size);
    return mesh;
}

GridStack on_lattice(const Mesh& mesh, const Lattice& lattice, float radius = 0.3f) {
    VoxelizeOptions options;
    options.grid.lattice = lattice;
    options.grid.radius = radius;
    options.grid.inner_band = options.grid.outer_band;
    return voxelize(mesh, triangulate(mesh).triangles, options);
}

/// The levels as OpenVDB reads them from a file.
std::vector<FloatGrid::Ptr> written(const GridStack& stack) {
    const ScratchFolder folder;
    const std::filesystem::path path = folder / "grid.vdb";
    write_grids(stack, path);
    openvdb::io::File file(path.string());
    file.open(/*delayLoad=*/false);
    std::vector<FloatGrid::Ptr> levels;
    const openvdb::GridPtrVecPtr grids = file.getGrids();
    for (const auto& grid : *grids)
        levels.push_back(openvdb::gridPtrCast<FloatGrid>(grid));
    file.close();
    return levels;
}

/// Signed distance to a box.
double distance_to(const Mesh& box, const Vec3d& p) {
    const Box bounds = box.box();
    const Vec3d q = glm::abs(p - bounds.center()) - 0.5 * (bounds.max - bounds.min);
    return glm::length(glm::max(q, Vec3d(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

TEST(LatticeOfGrids, TransformsAreEqualOnAllLevels) {
    const auto a = written(on_lattice(box_at({0, 0, 0}, {1, 1, 1}), tenths));
    const auto b = written(on_lattice(box_at({0.33, -7.1, 2.2}, {1.7, 0.4, 0.9}), tenths));
    ASSERT_GT(a.size(), 1u);
    double voxel = 0.1;
    for (std::size_t level = 0; level < std::min(a.size(), b.size()); ++level, voxel *= 2.0) {
        EXPECT_EQ(a[level]->transform(), b[level]->transform());
        EXPECT_EQ(a[level]->voxelSize(), openvdb::Vec3d(voxel)); // to the bit
        EXPECT_EQ(a[level]->indexToWorld(openvdb::Vec3d(0)), openvdb::Vec3d(0));
    }
}

TEST(LatticeOfGrids, DistancesAreThoseAtLatticePoints) {
    for (const Vec3d& low : {Vec3d(0, 0, 0), Vec3d(-3.21, 5, 0.07), Vec3d(1e5, -2e5, 0)}) {
        const Mesh mesh = box_at(low, {1, 0.7, 0.4});
        double voxel = 0.1;
        for (const FloatGrid::Ptr& level : written(on_lattice(mesh, tenths))) {
            for (auto value = level->cbeginValueOn(); value; ++value) {
                const openvdb::Vec3d at = level->indexToWorld(value.getCoord());
                ASSERT_NEAR(*value, distance_to(mesh, {at.x(), at.y(), at.z()}), 1e-4 * voxel) << value.getCoord();
            }
            voxel *= 2.0;
        }
    }
}

TEST(LatticeOfGrids, UnionsNeedNoResampling) {
    const Mesh a = box_at({0, 0, 0}, {1, 1, 1}), b = box_at({0.33, 0, 0}, {1, 1.2, 1});
    const auto all = written(on_lattice(a, tenths)).front(), other = written(on_lattice(b, tenths)).front();
    openvdb::tools::csgUnion(*all, *other);
    std::size_t count = 0;
    for (auto value = all->cbeginValueOn(); value; ++value, ++count) {
        const openvdb::Vec3d at = all->indexToWorld(value.getCoord());
        const Vec3d p(at.x(), at.y(), at.z());
        ASSERT_NEAR(*value, std::min(distance_to(a, p), distance_to(b, p)), 1e-5);
    }
    EXPECT_GT(count, 1000u);
}

TEST(LatticeOfGrids, ItMayBeginAnywhere) {
    const Lattice lattice{0.05, {0.017, -0.3, 1e3}};
    const auto level = written(on_lattice(box_at({5, 5, 5}, {1, 1, 1}), lattice)).front();
    EXPECT_EQ(level->indexToWorld(openvdb::Vec3d(0)), openvdb::Vec3d(0.017, -0.3, 1e3));
}

/// The field of a stack does not depend on where its lattice begins.
TEST(LatticeOfGrids, FieldsFarFromItsOriginKeepTheirPrecision) {
    const Mesh mesh = box_at({1e6, -3e6, 2e6}, {1, 0.7, 0.4});
    const GridStack stack = on_lattice(mesh, tenths);
    const LevelStack field(stack);
    for (int i = 0; i < 1000; ++i) {
        const Vec3d p = mesh.box().center() + Vec3d(i % 10 - 5, i / 10 % 10 - 5, i / 100 - 5) / 7.0;
        const double exact = distance_to(mesh, p);
        if (exact > -0.15 && exact < 0.3) { // the centre of the box is a ridge
            ASSERT_NEAR(field.map(stack.frame.to_unit(p)) * stack.frame.diagonal, exact, 0.05) << i;
        }
    }
    const Mesh surface = mesh_zero_surface(stack);
    EXPECT_NEAR(surface.box().max.x, 1e6 + 1.0, 1e-3);
    EXPECT_NEAR(surface.box().min.y, -3e6, 1e-3);
}

TEST(LatticeOfGrids, AStackComesBackToTheBit) {
    const GridStack stack = on_lattice(box_at({5, 6, 7}, {1, 2, 1}), {0.1, {0.03, 0, 0}});
    const ScratchFolder folder;
    const std::filesystem::path path = folder / "grid.vdb";
    write_grids(stack, path);
    const GridStack back = read_grids(path);
    const Lattice lattice = read_lattice(path);
    ASSERT_TRUE(back.lattice);
    EXPECT_EQ(back.lattice->voxel, 0.1);
    EXPECT_EQ(lattice.voxel, 0.1);
    EXPECT_EQ(lattice.origin, Vec3d(0.03, 0, 0));
    for (std::size_t level = 0; level < stack.levels.size(); ++level) {
        EXPECT_EQ(back.levels[level].origin, stack.levels[level].origin);
        EXPECT_EQ(back.levels[level].voxel, stack.levels[level].voxel);
    }
}

TEST(LatticeOfGrids, ExtendedStacksStayOnIt) {
    const GridStack stack = extend_levels(on_lattice(box_at({5, 6, 7}, {1, 2, 1}), tenths, 0.1f), 1.0f);
    ASSERT_GT(stack.levels.size(), 2u);
    const auto levels = written(stack);
    EXPECT_EQ(levels.back()->indexToWorld(openvdb::Vec3d(0)), openvdb::Vec3d(0));
    const GridStack direct = on_lattice(box_at({5, 6, 7}, {1, 2, 1}), tenths, 1.0f);
    ASSERT_EQ(direct.levels.size(), stack.levels.size());
    EXPECT_EQ(levels.back()->transform(), written(direct).back()->transform());
}

TEST(LatticeOfGrids, TooFarFromItsOriginIsRefused) {
    EXPECT_THROW(on_lattice(box_at({1e10, 0, 0}, {1, 1, 1}), tenths), InputError);
}

}
}
