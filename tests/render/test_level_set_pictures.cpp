/// Images of level sets against exact images of the same shapes.
#include "alcove/field/level_stack.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/render/renderer.h"
#include "mesh/solids.h"
#include "shapes.h"

#include <glm/gtc/quaternion.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace alcove {
namespace {

struct Shape {
    std::string name;
    Mesh mesh; ///< fine enough to match the shape to a hundredth of a voxel
    std::function<double(const Vec3d&)> distance;
    /// Allowed share of hits on another part of the shape, or misses. At edges that are not aligned with the grid, more
    /// rays pass between the edge and its rounded level set.
    double silhouette = 0.005;
};

double box_distance(const Vec3d& p, const Vec3d& half) {
    const Vec3d q = glm::abs(p) - half;
    return glm::length(glm::max(q, Vec3d(0.0))) + std::fmin(std::fmax(q.x, std::fmax(q.y, q.z)), 0.0);
}

/// A rotation that aligns no edge with the grid.
const glm::dquat turn = glm::angleAxis(0.7, glm::normalize(Vec3d(1.0, 2.0, 0.5)));

Mesh turned(Mesh mesh) {
    for (Vec3d& p : mesh.positions)
        p = turn * p;
    return mesh;
}

/// Two adjacent boxes, one half as high as the other: a step with a convex and a concave edge.
Mesh step_mesh() {
    const std::vector<glm::dvec2> outline{{-1, -0.5}, {1, -0.5}, {1, 0}, {0, 0}, {0, 0.5}, {-1, 0.5}};
    const auto count = static_cast<std::uint32_t>(outline.size());
    Mesh mesh;
    Face front, back;
    for (const double z : {-0.6, 0.6})
        for (const glm::dvec2& p : outline)
            mesh.positions.emplace_back(p.x, p.y, z);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t next = (i + 1) % count;
        mesh.add_face(Face{i, next, count + next, count + i});
        front.push_back(count + i);
        back.insert(back.begin(), i);
    }
    mesh.add_face(front);
    mesh.add_face(back);
    return mesh;
}

std::vector<Shape> shapes() {
    const Vec3d half(1.0, 0.6, 0.8);
    return {
        {"sphere", test::sphere_mesh(8), [](const Vec3d& p) { return glm::length(p) - 1.0; }},
        {"box", test::box_mesh(half, 1), [=](const Vec3d& p) { return box_distance(p, half); }},
        {"turned_box", turned(test::box_mesh(half, 1)),
         [=](const Vec3d& p) { return box_distance(glm::conjugate(turn) * p, half); }, 0.01},
        {"turned_step", turned(step_mesh()),
         [](const Vec3d& p) {
             const Vec3d q = glm::conjugate(turn) * p;
             return std::fmin(box_distance(q - Vec3d(-0.5, 0.0, 0.0), {0.5, 0.5, 0.6}),
                              box_distance(q - Vec3d(0.0, -0.25, 0.0), {1.0, 0.25, 0.6}));
         },
         0.01},
        {"torus", torus(1200, 400), [](const Vec3d& p) { return std::hypot(std::hypot(p.x, p.y) - 3.0, p.z) - 1.0; }}};
}

/// Distance to the hit of a ray of unit direction; infinite if it misses.
double exact_hit(const Shape& shape, const Vec3d& eye, const Vec3d& direction, double far) {
    double t = 0.0;
    for (int step = 0; step < 100000 && t < far; ++step) {
        const double d = shape.distance(eye + t * direction);
        if (d < 1e-9)
            return t;
        t += d;
    }
    return std::numeric_limits<double>::infinity();
}

class LevelSetPicture : public testing::TestWithParam<Shape> {};

/// Statistics of an image.
struct Seen {
    std::size_t hits = 0, silhouette = 0; ///< pixels; pixels that show another part of the shape, or none
    double sum = 0.0;                     ///< sum of errors along the rays, voxels
    double largest = 0.0;                 ///< largest error along a ray away from silhouettes, voxels
    double furthest = 0.0;                ///< largest distance of a hit from the shape, voxels
};

TEST_P(LevelSetPicture, ShowsTheExactShapeToAFractionOfAVoxel) {
    const Shape& shape = GetParam();
    const std::vector<Triangle> triangles = triangulate(shape.mesh).triangles;
    const GridStack stack = voxelize(shape.mesh, triangles, {.grid = {.voxel = 1.0f / 256.0f}});
    const Frame frame = frame_of(shape.mesh.box());
    const Renderable renderable{LevelStack(stack), frame, shape.mesh.box()};
    const double voxel = frame.diagonal / 256.0;
    const ImageSize size{480, 360};
    Seen seen;
    // A three-quarter view for each up axis.
    for (const Vec3d& up : {Vec3d(0, 1, 0), Vec3d(1, 0, 0), Vec3d(0, 0, 1)}) {
        const Camera camera = make_camera({.up = up}, shape.mesh.positions, size);
        const Image image = render(renderable, camera, {.samples = 1, .passes = Pass::depth});
        const auto direction = [&](std::size_t i) {
            return camera.direction(static_cast<double>(i % 480) + 0.5, static_cast<double>(i / 480) + 0.5);
        };
        std::vector<double> exact(image.pixels());
        for (std::size_t i = 0; i < image.pixels(); ++i)
            exact[i] = exact_hit(shape, camera.eye(), direction(i), 10.0 * frame.diagonal);
        for (std::size_t i = 480; i + 480 < image.pixels(); ++i) {
            const bool hit = image.alpha[i] > 0.0f, exactly = std::isfinite(exact[i]);
            const double t = double(image.depth[i]) / glm::dot(direction(i), camera.forward());
            const double error = std::fabs(t - exact[i]) / voxel;
            constexpr double another_part = 4.0;
            seen.silhouette += hit != exactly || (hit && error > another_part);
            if (!hit || !exactly)
                continue;
            ++seen.hits;
            seen.sum += error;
            seen.furthest =
                std::fmax(seen.furthest, std::fabs(shape.distance(camera.eye() + t * direction(i))) / voxel);
            bool beside = false;
            for (const std::size_t k : {i - 1, i + 1, i - 480, i + 480})
                beside = beside || !(std::fabs(exact[k] - exact[i]) < another_part * voxel);
            if (!beside)
                seen.largest = std::fmax(seen.largest, error);
        }
    }
    const double mean = seen.sum / static_cast<double>(seen.hits);
    std::printf("%s, 256 voxels: %zu hits; error along the ray: mean %.4f, max %.2f voxels; max distance "
                "from the shape: %.2f voxels; %zu pixels of the silhouette differ\n",
                shape.name.c_str(), seen.hits, mean, seen.largest, seen.furthest, seen.silhouette);
    EXPECT_GT(seen.hits, 150000u);
    EXPECT_LE(mean, 0.05);
    EXPECT_LE(seen.largest, 1.0);
    EXPECT_LE(seen.furthest, 0.5);
    EXPECT_LE(static_cast<double>(seen.silhouette), shape.silhouette * static_cast<double>(seen.hits));
}

INSTANTIATE_TEST_SUITE_P(Shapes, LevelSetPicture, testing::ValuesIn(shapes()),
                         [](const auto& shape) { return shape.param.name; });

}
}
