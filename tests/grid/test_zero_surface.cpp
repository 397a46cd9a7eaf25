#include "alcove/grid/voxelize.h"

#include "alcove/base/parallel.h"
#include "alcove/base/types.h"
#include "alcove/field/level_stack.h"
#include "alcove/grid/detail/vdb_grid.h"
#include "alcove/mesh/diagnose.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/vdb/vdb_file.h"
#include "scratch_folder.h"
#include "shapes.h"

#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>
#include <filesystem>
#include <random>

namespace alcove {
namespace {

constexpr double pi = 3.14159265358979;

/// A sphere as another program would write it, read as a stack.
GridStack foreign_sphere(double radius, const Vec3d& center, double voxel, float half_width,
                         const Vec3d& origin = Vec3d(0.0)) {
    openvdb::initialize();
    const Vec3d from_origin = center - origin;
    const auto grid = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
        static_cast<float>(radius), openvdb::Vec3f(from_origin.x, from_origin.y, from_origin.z),
        static_cast<float>(voxel), half_width);
    grid->transform().postTranslate({origin.x, origin.y, origin.z});
    const ScratchFolder folder;
    const std::filesystem::path path = folder / "grid.vdb";
    openvdb::io::File file(path.string());
    file.write(openvdb::GridPtrVec{grid});
    file.close();
    return read_grids(path);
}

void expect_sphere(const Mesh& mesh, double radius, const Vec3d& center, double voxel) {
    ASSERT_GT(mesh.vertex_count(), 100u);
    for (const Vec3d& p : mesh.positions)
        EXPECT_NEAR(glm::length(p - center), radius, 0.05 * voxel);
    const Closedness shape = closedness(mesh);
    EXPECT_TRUE(shape.closed());
    EXPECT_EQ(shape.components, 1u);
    EXPECT_EQ(shape.inverted_components, 0u); // faces outward
    EXPECT_NEAR(shape.signed_volume, 4.0 / 3.0 * pi * radius * radius * radius, 0.02 * shape.signed_volume);
}

TEST(MeshGrid, TheZeroSurfaceOfAForeignSphereIsTheSphere) {
    const struct {
        double radius;
        Vec3d center;
        double voxel;
        float half_width;
        Vec3d origin;
    } spheres[] = {{1.0, {0, 0, 0}, 0.05, 3.0f, {0, 0, 0}},
                   {0.37, {100, -7, 3}, 0.0131, 2.0f, {0.004, 0.1, -0.03}},
                   {1000.0, {3, 2, 1}, 41.7, 5.0f, {-1e4, 0, 7}}};
    for (const auto& [radius, center, voxel, half_width, origin] : spheres) {
        const Mesh mesh = mesh_zero_surface(foreign_sphere(radius, center, voxel, half_width, origin));
        expect_sphere(mesh, radius, center, voxel);
        for (std::size_t f = 0; f < mesh.face_count(); ++f)
            ASSERT_EQ(mesh.face(f).size(), 4u);
    }
}

TEST(MeshGrid, OneOfOurOwnStacksComesBackToItsPlace) {
    Mesh mesh;
    test::add_part(mesh, test::sphere_mesh(5), 37.0, {1e4, -2e3, 5.5});
    const GridOptions grid{.radius = 0.2f, .voxel = 1.0f / 64.0f};
    const GridStack stack = voxelize(mesh, triangulate(mesh).triangles, {.grid = grid});
    expect_sphere(mesh_zero_surface(stack), 37.0, {1e4, -2e3, 5.5}, stack.levels[0].voxel * stack.frame.diagonal);
}

TEST(MeshGrid, AdaptivityMergesFacesOnTheSurface) {
    const GridStack stack = foreign_sphere(1.0, Vec3d(0.0), 0.02, 3.0f);
    const Mesh fine = mesh_zero_surface(stack), coarse = mesh_zero_surface(stack, 0.5f);
    EXPECT_LT(coarse.face_count(), fine.face_count() / 4);
    EXPECT_EQ(closedness(coarse).inverted_components, 0u);
    for (const Vec3d& p : coarse.positions)
        EXPECT_NEAR(glm::length(p), 1.0, 0.02);
}

TEST(MeshGrid, DoesNotDependOnTheNumberOfThreads) {
    const GridStack stack = foreign_sphere(1.0, Vec3d(0.0), 0.02, 3.0f);
    const Mesh many = mesh_zero_surface(stack);
    const ThreadLimit one(1);
    const Mesh single = mesh_zero_surface(stack);
    EXPECT_EQ(many.positions, single.positions);
    EXPECT_EQ(many.corners, single.corners);
}

TEST(MeshGrid, RefusesSheetsAndGridsWithoutASurface) {
    const Mesh bowl = test::sphere_mesh(3, [](const Vec3d& p) { return p.y < 0.2; });
    EXPECT_THROW(mesh_zero_surface(voxelize(bowl, triangulate(bowl).triangles)), InputError);

    GridStack stack = foreign_sphere(1.0, Vec3d(0.0), 0.1, 3.0f);
    const auto outside = stack.levels[0].grid->grid->deepCopy();
    for (auto value = outside->beginValueAll(); value; ++value)
        value.setValue(std::fabs(*value) + 0.01f);
    stack.levels[0].grid = std::make_shared<VdbGrid>(VdbGrid{outside});
    EXPECT_THROW(mesh_zero_surface(stack), InputError);
}

TEST(MeshGrid, ExtendedLevelsKeepTheGridAndHoldFurtherDistances) {
    const double radius = 3.0;
    const Vec3d center(10, 20, -5);
    const GridStack thin = foreign_sphere(radius, center, 0.1, 3.0f);
    const GridStack stack = extend_levels(thin, 0.4f);
    ASSERT_GT(stack.levels.size(), 2u);
    EXPECT_EQ(stack.levels[0].grid, thin.levels[0].grid);
    EXPECT_EQ(stack.sign, Sign::solid);
    EXPECT_GE(stack.reach(), 0.4f);
    for (std::size_t l = 1; l < stack.levels.size(); ++l)
        EXPECT_NEAR(stack.levels[l].voxel / stack.levels[l - 1].voxel, 2.0f, 1e-5f);
    EXPECT_EQ(extend_levels(stack, 0.4f).levels.size(), stack.levels.size());

    const LevelStack field(stack);
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    const double reach = 0.4 * stack.frame.diagonal;
    for (int i = 0; i < 2000; ++i) {
        const Vec3d out = glm::normalize(Vec3d(normal(random), normal(random), normal(random)));
        const double height = reach * i / 2000.0;
        const float d = field.map(stack.frame.to_unit(center + (radius + height) * out));
        EXPECT_NEAR(d * stack.frame.diagonal, height, 0.06 * std::max(height, 0.1)) << height;
    }
}

TEST(MeshGrid, AStackThatKnowsTooLittleOfTheInsideIsReplacedWhereItIsAsked) {
    const Mesh mesh = test::sphere_mesh(6);
    const GridStack thin = voxelize(mesh, triangulate(mesh).triangles, {.grid = {.voxel = 1.0f / 64}});
    EXPECT_FALSE(thin.knows_inside());
    EXPECT_EQ(extend_levels(thin, 0.1f).levels.front().grid, thin.levels.front().grid);
    const GridStack whole = extend_levels(thin, 0.2f, true);
    EXPECT_TRUE(whole.knows_inside());
    EXPECT_FLOAT_EQ(whole.levels.front().voxel, thin.levels.front().voxel);
    const LevelStack field(whole);
    const auto radius = static_cast<float>(1.0 / mesh.box().diagonal());
    for (const float depth : {0.02f, 0.05f, 0.1f}) {
        const float x = radius - depth, y = 0.0f, z = 0.0f;
        float d = 0.0f;
        field.map(Points{&x, &y, &z, 1}, depth, &d);
        EXPECT_NEAR(d, -depth, 0.003f) << depth;
    }
    // Without our metadata, the fill value of the inside determines the inner band.
    EXPECT_TRUE(foreign_sphere(1.0, Vec3d(0.0), 0.05, 3.0f).knows_inside());
    EXPECT_EQ(extend_levels(whole, 0.2f, true).levels.front().grid, whole.levels.front().grid);
}

TEST(MeshGrid, AStackInAnotherFrameIsTheSameSurface) {
    const GridStack stack = foreign_sphere(3.0, {10, 20, -5}, 0.1, 5.0f);
    const Frame frame{{9, 22, -6}, 4.0};
    const LevelStack a(stack), b(reframed(stack, frame));
    for (const Vec3d& p : {Vec3d(10, 23, -5), Vec3d(13.2, 20, -5), Vec3d(10, 20, -1.9), Vec3d(7.1, 20, -5)})
        EXPECT_NEAR(b.map(frame.to_unit(p)) * frame.diagonal, a.map(stack.frame.to_unit(p)) * stack.frame.diagonal,
                    1e-4);
}

TEST(MeshOfASampler, LiesOnTheSurfaceAndTurnsOutward) {
    const Vec3 center(0.05f, -0.1f, 0.02f);
    const float radius = 0.3f;
    const Mesh mesh = mesh_zero_surface(
        [&](std::span<const Vec3> points, float* distances) {
            for (const Vec3& p : points)
                *distances++ = glm::length(p - center) - radius;
        },
        1.0f / 128.0f);
    EXPECT_GT(mesh.face_count(), 5000u);
    for (const Vec3d& p : mesh.positions)
        EXPECT_NEAR(glm::length(p - Vec3d(center)), double(radius), 0.2 / 128.0);
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const auto corners = mesh.face(f);
        const Vec3d &a = mesh.positions[corners[0]], &b = mesh.positions[corners[1]], &c = mesh.positions[corners[2]];
        EXPECT_GT(glm::dot(glm::cross(b - a, c - a), a - Vec3d(center)), 0.0);
    }
    EXPECT_TRUE(closedness(mesh).closed());
}

TEST(MeshOfASampler, IsRefusedWhereThereIsNoSurface) {
    const Sampler far = [](std::span<const Vec3> points, float* distances) {
        std::fill_n(distances, points.size(), 5.0f);
    };
    EXPECT_THROW(mesh_zero_surface(far, 1.0f / 64.0f), InputError);
}

}
}
