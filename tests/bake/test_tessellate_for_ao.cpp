/// tessellate_for_ao() adds vertices where ao varies, and nowhere else.
#include "alcove/bake/bake.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/occlusion/methods/exact.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alcove {
namespace {

/// A floor of one quad, 8 x 8, under a box of side 2 that floats `gap` above it. Texture coordinates and colours are
/// linear in the position.
Mesh box_over_quad(double gap) {
    Mesh mesh;
    mesh.positions = {{-4, 0, -4}, {4, 0, -4}, {4, 0, 4}, {-4, 0, 4}};
    mesh.add_face(std::vector<std::uint32_t>{0, 3, 2, 1});
    test::add_part(mesh, test::box_mesh(Vec3d(1.0), 1), 1.0, {0.3, 1.0 + gap, 0.2});
    for (const Vec3d& p : mesh.positions) {
        mesh.vertex_uvs.emplace_back(p.x / 8.0 + 0.5, p.z / 8.0 + 0.5);
        mesh.vertex_colors.push_back({static_cast<std::uint8_t>(std::lround(128.0 + 30.0 * p.x)), 7, 9, 255});
    }
    return mesh;
}

/// RMS of the difference between exact rays at points of the floor and the interpolated values of its vertices.
double interpolation_error(const Mesh& mesh, const std::vector<float>& ao, float radius) {
    const Frame frame = frame_of(mesh.box());
    std::vector<Vec3> positions;
    for (const Vec3d& p : mesh.positions)
        positions.push_back(frame.to_unit(p));
    const std::vector<Triangle> triangles = triangulate(mesh).triangles;
    const RaySurface surface(positions, triangles);
    std::vector<Surfel> points;
    std::vector<double> interpolated, weights;
    for (const Triangle& t : triangles) {
        if (mesh.positions[t[0]].y != 0.0 || mesh.positions[t[1]].y != 0.0 || mesh.positions[t[2]].y != 0.0)
            continue;
        const double area = 0.5 * glm::length(glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                                                         mesh.positions[t[2]] - mesh.positions[t[0]]));
        const int n = std::max(2, static_cast<int>(std::ceil(std::sqrt(area) / 0.2)));
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n - i; ++j) {
                const double u = (i + 1.0 / 3.0) / n, v = (j + 1.0 / 3.0) / n, w = 1.0 - u - v;
                const Vec3d p = w * mesh.positions[t[0]] + u * mesh.positions[t[1]] + v * mesh.positions[t[2]];
                points.push_back({frame.to_unit(p), {0, 1, 0}});
                interpolated.push_back(w * ao[t[0]] + u * ao[t[1]] + v * ao[t[2]]);
                weights.push_back(area / n / n);
            }
    }
    const std::vector<float> exact = evaluate_ao(
        points, surface, Exact{.radius = radius / static_cast<float>(frame.diagonal), .rays = 1024, .seed = 77});
    double squares = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        squares += weights[i] * std::pow(exact[i] - interpolated[i], 2);
        sum += weights[i];
    }
    return std::sqrt(squares / sum);
}

TEST(TessellateForAo, GivesAQuadTheShadowOfTheBoxAboveIt) {
    for (const double gap : {0.1, 0.5}) {
        const Mesh mesh = box_over_quad(gap);
        const BakeOptions options{.radius = "2"};
        EXPECT_GT(interpolation_error(mesh, bake(mesh, options).ao(), 2.0f), 0.1)
            << "no corner of the quad is occluded";
        const Mesh split = tessellate_for_ao(mesh, options);
        const Baked baked = bake(split, options);
        EXPECT_LE(interpolation_error(split, baked.ao(), 2.0f), 0.03) << gap;
        EXPECT_LT(split.vertex_count(), 10'000u);
        for (const std::string& warning : baked.warnings)
            EXPECT_EQ(warning.find("--tessellate"), std::string::npos) << warning;
        ASSERT_EQ(split.vertex_uvs.size(), split.vertex_count());
        ASSERT_EQ(split.vertex_colors.size(), split.vertex_count());
        for (std::size_t v = 0; v < split.vertex_count(); ++v) {
            EXPECT_NEAR(split.vertex_uvs[v].x, split.positions[v].x / 8.0 + 0.5, 1e-5);
            EXPECT_NEAR(split.vertex_colors[v][0], 128.0 + 30.0 * split.positions[v].x, 8.0);
        }
    }
}

TEST(TessellateForAo, LeavesAloneWhatIsOpen) {
    const Mesh box = test::box_mesh(Vec3d(1.0), 1);
    const Mesh split = tessellate_for_ao(box, {.radius = "1"});
    EXPECT_EQ(split.vertex_count(), box.vertex_count());
    EXPECT_EQ(split.corners, box.corners);
}

}
}
