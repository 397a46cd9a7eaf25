/// Surfaces that do not bound a solid: open, nested, inside out. Compared with exact rays, occlusion must be as
/// accurate as on a closed mesh.
#include "alcove/field/level_stack.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/normals.h"
#include "alcove/occlusion/estimator.h"
#include "alcove/occlusion/methods/traced.h"
#include "exact_distance.h"
#include "real_mesh.h"
#include "shapes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace alcove {
namespace {

struct Baked {
    Sign sign;
    double rmse = 0.0;
    std::vector<float> ao;
    std::vector<Surfel> surfels;
};

Baked bake_against_exact(const Mesh& mesh, float radius, SignChoice sign = SignChoice::automatic) {
    const std::vector<Triangle> triangles = triangulate(mesh).triangles;
    const Frame frame = frame_of(mesh.box());
    VoxelizeOptions options;
    options.grid.radius = radius;
    options.sign = sign;
    const GridStack stack = voxelize(mesh, triangles, options);
    Baked baked{stack.sign, 0.0, {}, make_surfels(mesh, triangles, frame)};
    baked.ao = evaluate_ao(baked.surfels, LevelStack(stack), Traced{.radius = radius, .rays = 256});
    const test::ExactSurface exact(mesh, triangles, frame);
    std::size_t counted = 0;
    for (std::size_t i = 0; i < baked.ao.size(); ++i)
        if (baked.surfels[i].has_normal()) {
            const double error = baked.ao[i] - exact.visibility(baked.surfels[i], radius, 1024);
            baked.rmse += error * error;
            ++counted;
        }
    baked.rmse = std::sqrt(baked.rmse / static_cast<double>(counted));
    return baked;
}

TEST(OpenMesh, SphereWithHolesIsAsRightAsTheWholeOne) {
    for (const float radius : {0.1f, 0.5f}) {
        const Baked whole = bake_against_exact(test::sphere_mesh(4), radius);
        EXPECT_EQ(whole.sign, Sign::solid);
        for (const double missing : {0.0, 0.01, 0.2, 0.5}) {
            // Removes a cap with the share `missing` of the area, and in any case one facet.
            const double height = 1.0 - 2.0 * missing;
            bool first = true;
            const auto keep = [&](const Vec3d& p) { return !std::exchange(first, false) && p.z < height; };
            const Baked open = bake_against_exact(test::sphere_mesh(4, keep), radius);
            EXPECT_EQ(open.sign, Sign::sheet);
            fmt::print("sphere without a facet and {} %, radius {}: RMSE {:.4f}, complete {:.4f}\n", 100 * missing,
                       radius, open.rmse, whole.rmse);
            EXPECT_LE(open.rmse, 1.25 * whole.rmse + 1e-3);
        }
    }
}

TEST(OpenMesh, ElephantWithHolesIsAsRightAsTheWholeOne) {
    const test::RealMesh whole("elephant.off"), open("elephant-with-holes.off");
    for (const float radius : {0.1f, 0.5f}) {
        const Baked a = bake_against_exact(whole.mesh, radius), b = bake_against_exact(open.mesh, radius);
        EXPECT_EQ(a.sign, Sign::solid);
        EXPECT_EQ(b.sign, Sign::sheet);
        fmt::print("elephant, radius {}: RMSE {:.4f}, with holes {:.4f}\n", radius, a.rmse, b.rmse);
        EXPECT_LE(b.rmse, 1.25 * a.rmse);
    }
}

TEST(OpenMesh, TakenForASheetAClosedMeshIsAsRight) {
    const test::RealMesh elephant("elephant.off");
    const Baked solid = bake_against_exact(elephant.mesh, 0.2f);
    const Baked sheet = bake_against_exact(elephant.mesh, 0.2f, SignChoice::sheet);
    fmt::print("elephant as a solid: RMSE {:.4f}, as a sheet {:.4f}\n", solid.rmse, sheet.rmse);
    EXPECT_LE(sheet.rmse, 1.1 * solid.rmse);
}

TEST(OpenMesh, MeshWithBorder) {
    const test::RealMesh real("mesh_with_border.off");
    const Baked baked = bake_against_exact(real.mesh, 0.2f);
    fmt::print("mesh_with_border: RMSE {:.4f}\n", baked.rmse);
    EXPECT_EQ(baked.sign, Sign::sheet);
    EXPECT_LE(baked.rmse, 0.05);
}

/// A shell inside another, both oriented outward: the inner one is occluded by the outer one across the gap.
TEST(NestedShells, AreBothKept) {
    Mesh mesh = test::sphere_mesh(5);
    const std::size_t outer = mesh.vertex_count();
    test::add_part(mesh, test::sphere_mesh(5), 0.5, {0, 0, 0});
    // The gap is half the outer radius: 0.144 of the diagonal.
    const Baked narrow = bake_against_exact(mesh, 0.1f), wide = bake_against_exact(mesh, 0.4f);
    EXPECT_EQ(narrow.sign, Sign::sheet);
    for (std::size_t v = outer; v < narrow.ao.size(); ++v) {
        EXPECT_GT(narrow.ao[v], 0.98f);
        EXPECT_LT(wide.ao[v], 0.02f);
    }
    for (std::size_t v = 0; v < outer; ++v)
        EXPECT_GT(wide.ao[v], 0.98f);
}

/// A shell that is inside out is a cavity, also for exact rays.
TEST(InsideOut, TheCavityIsSeenFromInside) {
    Mesh mesh = test::sphere_mesh(5), inverted;
    inverted.positions = mesh.positions;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        std::vector<std::uint32_t> face(mesh.face(f).rbegin(), mesh.face(f).rend());
        inverted.add_face(face);
    }
    const float radius = 0.3f; // the radius of the sphere is 0.5/√3
    const Baked baked = bake_against_exact(inverted, radius);
    const double expected = 1.0 - std::pow(radius * std::sqrt(3.0), 2);
    EXPECT_EQ(baked.sign, Sign::sheet);
    for (const float ao : baked.ao)
        EXPECT_NEAR(ao, expected, 0.05);
}

}
}
