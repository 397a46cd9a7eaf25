/// Rendering with triangles: mesh normals, painted values, exact rays.
#include "scene_text.h"

#include "alcove/base/types.h"
#include "alcove/mesh/files.h"
#include "alcove/scene/scene.h"
#include "shapes.h"

#include <cmath>

namespace alcove::test {
namespace {

struct Drawn {
    BuiltScene built;
    Camera camera;
    Image image;
};

Drawn draw(const Scene& scene, PassSet passes) {
    BuiltScene built = build_scene(scene, passes);
    const Camera camera = make_camera(scene.camera, built.points, scene.size);
    Image image = render(built.renderable, camera, rendering_of(scene, built, camera, passes));
    return {std::move(built), camera, std::move(image)};
}

/// A file with a coarse ball, whose vertices are black above and white below.
class BallFile : public testing::Test {
  protected:
    BallFile() { write("ball.ply", 2); }

    void write(const char* name, int level) const {
        Mesh mesh = sphere_mesh(level);
        for (const Vec3d& p : mesh.positions)
            mesh.vertex_colors.push_back(p.y > 0.0 ? Color{0, 0, 0, 255} : Color{255, 255, 255, 255});
        std::ofstream ply(folder_ / name);
        ply << "ply\nformat ascii 1.0\nelement vertex " << mesh.positions.size()
            << "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar "
               "green\n"
               "property uchar blue\nelement face "
            << mesh.face_count() << "\nproperty list uchar int vertex_indices\nend_header\n";
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            const Vec3d& p = mesh.positions[v];
            const int grey = mesh.vertex_colors[v][0];
            ply << p.x << " " << p.y << " " << p.z << " " << grey << " " << grey << " " << grey << "\n";
        }
        for (std::size_t f = 0; f < mesh.face_count(); ++f)
            ply << "3 " << mesh.face(f)[0] << " " << mesh.face(f)[1] << " " << mesh.face(f)[2] << "\n";
    }

    Scene scene(const std::string& more) const {
        return scene_from("[image]\nwidth = 120\nheight = 90\nsamples = 1\n[occlusion]\nmethod = \"none\"\n[[object]]\n"
                          "shape = \"mesh\"\nfile = \"" +
                          (folder_ / "ball.ply").string() + "\"\n" + more);
    }

    const ScratchFolder folder_;
};

TEST_F(BallFile, NormalsOfTheMeshAreSmoothAndThoseOfTheFieldAreNot) {
    // Interpolated vertex normals of a coarse ball are close to those of the exact ball.
    const auto largest_angle = [](const Drawn& drawn) {
        double largest = 0.0;
        for (std::size_t i = 0; i < drawn.image.pixels(); ++i) {
            const Vec3d out = glm::normalize(Vec3d(drawn.image.position[i]));
            const Vec3d ray = glm::normalize(Vec3d(drawn.image.position[i]) - drawn.camera.eye());
            if (drawn.image.alpha[i] == 1.0f && glm::dot(out, ray) < -0.4)
                largest = std::fmax(largest, std::acos(std::fmin(1.0, glm::dot(out, Vec3d(drawn.image.normal[i])))));
        }
        return largest * 180.0 / 3.14159265358979;
    };
    const PassSet passes = Pass::normal | Pass::position | Pass::depth;
    const double field = largest_angle(draw(scene("normals = \"field\"\n"), passes));
    const double mesh = largest_angle(draw(scene("normals = \"mesh\"\nrotate = [10, 20, 30]\n"), passes));
    EXPECT_GT(field, 8.0);
    EXPECT_LT(mesh, 0.6 * field);
}

TEST_F(BallFile, PlacesAreMovedOntoTheTriangles) {
    const Drawn drawn = draw(scene("normals = \"mesh\"\n"), Pass::position | Pass::depth);
    const Mesh ball = sphere_mesh(2);
    double inside = 1.0; // distance from the origin to the nearest face plane
    for (std::size_t f = 0; f < ball.face_count(); ++f) {
        const Vec3d &a = ball.positions[ball.face(f)[0]], &b = ball.positions[ball.face(f)[1]],
                    &c = ball.positions[ball.face(f)[2]];
        inside = std::fmin(inside, glm::dot(glm::normalize(glm::cross(b - a, c - a)), a) - 1e-5);
    }
    int seen = 0;
    for (std::size_t i = 0; i < drawn.image.pixels(); ++i) {
        if (drawn.image.alpha[i] < 1.0f)
            continue;
        ++seen;
        // The point on the pixel's ray at the stored depth.
        const Vec3d ray =
            drawn.camera.direction(static_cast<double>(i % 120) + 0.5, static_cast<double>(i / 120) + 0.5);
        const Vec3d p =
            drawn.camera.eye() + ray * (double(drawn.image.depth[i]) / glm::dot(ray, drawn.camera.forward()));
        EXPECT_NEAR(glm::length(p - Vec3d(drawn.image.position[i])), 0.0, 1e-4);
        EXPECT_LE(glm::length(p), 1.0 + 1e-5); // triangles are inside the ball
        EXPECT_GE(glm::length(p), inside);
    }
    EXPECT_GT(seen, 2000);
}

TEST_F(BallFile, PaintedValuesMultiplyOcclusion) {
    Scene painted = scene("painted = true\n"), plain = scene("");
    painted.camera.eye = plain.camera.eye = Vec3d(4, 0, 0);
    for (Scene* one : {&painted, &plain}) {
        one->light.sun = Vec3(0.0f);
        one->light.bounce = Vec3(0.0f);
        one->light.sky = Vec3(1.0f);
        one->occlusion.use = OcclusionUse::ambient;
    }
    const PassSet passes = Pass::beauty | Pass::position;
    const Image dark = draw(painted, passes).image, bright = draw(plain, passes).image;
    int above = 0, below = 0;
    for (std::size_t i = 0; i < dark.pixels(); ++i) {
        if (dark.alpha[i] < 1.0f || bright.alpha[i] < 1.0f)
            continue;
        const double share = double(dark.color[i].x) / double(bright.color[i].x);
        // Further than a triangle from the equator, all corners of a triangle have the same colour.
        if (dark.position[i].y > 0.45f) {
            EXPECT_NEAR(share, 0.0, 1e-6);
            ++above;
        } else if (dark.position[i].y < -0.45f) {
            EXPECT_NEAR(share, 1.0, 1e-6);
            ++below;
        }
    }
    EXPECT_GT(above, 100);
    EXPECT_GT(below, 100);
}

TEST_F(BallFile, OfAnObjectAreNotTakenForThoseOfOneThatCrossesIt) {
    // A sphere that intersects the ball: each keeps its own normals where they meet.
    const Drawn drawn =
        draw(scene("normals = \"mesh\"\nvoxel = 0.1\n[[object]]\nshape = \"sphere\"\ncenter = [0.8, 0.6, "
                   "0.5]\nradius = 0.7\n"),
             Pass::normal | Pass::position | Pass::object);
    int seen = 0;
    for (std::size_t i = 0; i < drawn.image.pixels(); ++i)
        if (drawn.image.object[i] == 2.0f) {
            ++seen;
            const Vec3d out = glm::normalize(Vec3d(drawn.image.position[i]) - Vec3d(0.8, 0.6, 0.5));
            EXPECT_GT(glm::dot(out, Vec3d(drawn.image.normal[i])), 0.999);
        }
    EXPECT_GT(seen, 500);
}

/// A coarse field extends beyond the outlines. Samples there show what the ray meets next: another object, or the
/// ground.
TEST_F(BallFile, OutlinesAreThoseOfTheTriangles) {
    std::ofstream(folder_ / "square.off") << "OFF 4 1 0\n-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\n4 0 1 2 3\n";
    const std::string square = "[[object]]\nshape = \"mesh\"\nfile = \"" + (folder_ / "square.off").string() + "\"\n";
    for (const bool with_another : {false, true}) {
        Scene scene = scene_from(
            "[image]\nwidth = 80\nheight = 80\nsamples = 1\n[occlusion]\nmethod = \"none\"\n[camera]\n"
            "eye = [0, 0, 4]\nlook_at = [0, 0, 0]\nfov = 53.13010235\n" +
            square + "voxel = 0.2\n" + (with_another ? square + "scale = 2\ntranslate = [0, 0, -0.5]\n" : ""));
        const Drawn drawn = draw(scene, Pass::object | Pass::depth);
        for (int y = 0; y < 80; ++y)
            for (int x = 0; x < 80; ++x) {
                // Twenty pixels per unit at the depth of the square.
                const double u = (x - 39.5) / 20.0, v = (y - 39.5) / 20.0, out = std::fmax(std::fabs(u), std::fabs(v));
                const auto i = static_cast<std::size_t>(80 * y + x);
                if (std::fabs(out - 1.0) < 1e-3 || out > 1.7)
                    continue;
                EXPECT_EQ(drawn.image.object[i], out < 1.0 ? 1.0f : with_another ? 2.0f : 0.0f) << x << ", " << y;
                if (out < 1.0 || with_another) {
                    EXPECT_NEAR(drawn.image.depth[i], out < 1.0 ? 4.0f : 4.5f, 1e-4f);
                }
            }
    }
}

TEST_F(BallFile, ABlendedCutOfAMeshIsThatOfItsShape) {
    write("fine.ply", 5);
    const auto cut = [&](const std::string& ball) {
        return build_scene(scene_from("[[object]]\nshape = \"difference\"\nblend = 0.6\n[[object.part]]\n" + ball +
                                      "[[object.part]]\nshape = \"sphere\"\ncenter = [0, 1.2, 0]\nradius = 0.8\n"));
    };
    const BuiltScene meshed = cut("shape = \"mesh\"\nfile = \"" + (folder_ / "fine.ply").string() + "\"\n");
    const BuiltScene exact = cut("shape = \"sphere\"\n");
    for (double x = -0.9; x < 1.0; x += 0.1)
        for (double y = -0.9; y < 1.0; y += 0.1) {
            const Vec3d p(x, y, 0.05);
            const auto at = [&](const BuiltScene& built) {
                return double(built.renderable.field.map(built.renderable.frame.to_unit(p))) *
                       built.renderable.frame.diagonal;
            };
            if (std::fabs(at(exact)) < 0.1) {
                EXPECT_NEAR(at(meshed), at(exact), 0.015);
            }
        }
}

TEST(TrianglesOfAScene, WhatIsSmallHasThemToo) {
    const Scene scene = scene_from(R"(
[occlusion]
method = "exact"
[[object]]
shape = "sphere"
radius = 0.01
[[object]]
shape = "sphere"
radius = 100
center = [500, 0, 0]
)");
    EXPECT_NE(build_scene(scene).renderable.mesh, nullptr);
}

/// Exact rays against the triangles of primitives and differences, compared with rays traced through their fields.
TEST(TrianglesOfAScene, ExactRaysAgreeWithTracedOnes) {
    Scene scene = scene_from(R"(
[image]
width = 96
height = 72
samples = 1
[occlusion]
method = "traced"
radius = 0.5
rays = 256
[ground]
[[object]]
shape = "difference"
part = [{ shape = "box", size = [2, 1, 2] }, { shape = "sphere", center = [0, 0.5, 0], radius = 0.6 }]
[[object]]
shape = "torus"
ring = 0.5
tube = 0.15
translate = [0, 0.7, 0]
)");
    const Image traced = draw(scene, Pass::ao).image;
    scene.occlusion.choose("exact");
    scene.occlusion.parameters = {{"rays", 256.0}};
    const Image exact = draw(scene, Pass::ao).image;
    double sum = 0.0, bias = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < exact.pixels(); ++i)
        if (exact.alpha[i] == 1.0f) {
            const double error = double(exact.ao[i]) - double(traced.ao[i]);
            sum += error * error;
            bias += error;
            ++count;
        }
    EXPECT_GT(count, 3000);
    EXPECT_LT(std::sqrt(sum / count), 0.03);
    EXPECT_LT(std::fabs(bias / count), 0.005);
}

}
}
