/// Compares the search for all surfels at once with a test of each surfel against each triangle.
#include "alcove/occlusion/detail/touched_surfels.h"

#include "alcove/base/detail/closest_point.h"
#include "alcove/mesh/normals.h"
#include "alcove/mesh/triangulate.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace alcove {
namespace {

struct Scene {
    std::vector<Triangle> triangles;
    std::vector<Surfel> surfels;
    std::vector<Vec3> positions;

    explicit Scene(const Mesh& mesh) : triangles(triangulate(mesh).triangles) {
        surfels = make_surfels(mesh, triangles, frame_of(mesh.box()));
        for (const Surfel& s : surfels)
            positions.push_back(s.position);
    }

    std::vector<std::uint32_t> touched_one_by_one(float offset) const {
        std::vector<std::uint32_t> touched;
        for (std::uint32_t i = 0; i < surfels.size(); ++i) {
            const auto touches = [&](const Triangle& t) {
                return !uses_vertex(i, t) &&
                       glm::length(closest_on_triangle(Vec3d(positions[t[0]]), Vec3d(positions[t[1]]),
                                                       Vec3d(positions[t[2]]), Vec3d(positions[i]))
                                       .offset) <= double(offset);
            };
            if (surfels[i].has_normal() && std::any_of(triangles.begin(), triangles.end(), touches))
                touched.push_back(i);
        }
        return touched;
    }
};

/// Expects the same surfels from both. \return the number of touched surfels
std::size_t expect_same(const Mesh& mesh, float offset) {
    const Scene scene(mesh);
    const auto touched = find_touched(scene.surfels, RaySurface(scene.positions, scene.triangles), offset, uses_vertex);
    EXPECT_TRUE(touched);
    EXPECT_EQ(touched.value_or(std::vector<std::uint32_t>()), scene.touched_one_by_one(offset));
    return touched->size();
}

TEST(TouchedSurfels, AreThoseThatTouchAnotherPart) {
    Mesh mesh = test::sphere_mesh(4);
    EXPECT_EQ(expect_same(mesh, 1e-4f), 0u); // a smooth mesh does not touch itself
    test::add_part(mesh, test::sphere_mesh(4), 1.0, {0.7, 0.1, 0.2});
    test::add_part(mesh, test::box_mesh({0.5, 0.5, 0.5}, 6), 1.0, {2.2, 0.1, 0.2});
    test::add_part(mesh, test::box_mesh({0.5, 0.5, 0.5}, 4), 1.0, {3.2, 0.1, 0.2}); // shares a side
    EXPECT_GT(expect_same(mesh, 1e-4f), 50u);
    EXPECT_GT(expect_same(mesh, 3e-3f), 60u);
}

TEST(TouchedSurfels, AreFoundAmongTrianglesOfAllSizes) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const auto somewhere = [&](double size) { return size * Vec3d(unit(random), unit(random), unit(random)); };
    Mesh mesh;
    for (int i = 0; i < 600; ++i) {
        const Vec3d center = somewhere(1.0);
        const double size = std::exp(-3.0 + 2.0 * unit(random));
        for (int corner = 0; corner < 3; ++corner)
            mesh.positions.push_back(center + somewhere(size));
        const auto first = static_cast<std::uint32_t>(mesh.positions.size() - 3);
        mesh.add_face(std::array{first, first + 1, first + 2});
    }
    EXPECT_GT(expect_same(mesh, 2e-3f), 20u);
}

TEST(TouchedSurfels, AreLeftToASearchForEachWhereThatIsFaster) {
    const Scene scene(test::sphere_mesh(4));
    const RaySurface surface(scene.positions, scene.triangles);
    EXPECT_FALSE(find_touched(std::span(scene.surfels).first(100), surface, 1e-4f, uses_vertex));
    Mesh mesh = test::sphere_mesh(5); // with large triangles across many cells
    for (int i = 0; i < 40; ++i)
        test::add_part(mesh, test::box_mesh({1.0, 1.0, 1.0}, 1), 1.0 - 0.005 * i, {0.3, 0.2, 0.1});
    const Scene large(mesh);
    EXPECT_FALSE(find_touched(large.surfels, RaySurface(large.positions, large.triangles), 1e-4f, uses_vertex));
}

}
}
