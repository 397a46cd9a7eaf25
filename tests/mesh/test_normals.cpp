#include "alcove/mesh/normals.h"

#include "alcove/base/parallel.h"
#include "alcove/base/types.h"
#include "alcove/mesh/triangulate.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace alcove {
namespace {

Mesh tetrahedron() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const Triangle& t : {Triangle{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
        mesh.add_face(t);
    return mesh;
}

Mesh random_soup(std::mt19937& random, std::size_t vertices, std::size_t faces) {
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    Mesh mesh;
    for (std::size_t v = 0; v < vertices; ++v)
        mesh.positions.emplace_back(unit(random), unit(random), unit(random));
    while (mesh.face_count() < faces) {
        const auto corner = [&] { return static_cast<std::uint32_t>(random() % vertices); };
        mesh.add_face(Triangle{corner(), corner(), corner()});
    }
    return mesh;
}

/// Sums over all triangles for each vertex, in extended precision and scene units.
std::vector<Vec3d> slow_normals(const Mesh& mesh, const std::vector<Triangle>& triangles) {
    using Long = glm::vec<3, long double>;
    std::vector<Vec3d> normals;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        Long sum(0.0L);
        for (const Triangle& t : triangles)
            if (t[0] == v || t[1] == v || t[2] == v) {
                const Long a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
                sum += glm::cross(b - a, c - a);
            }
        const long double length = std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
        normals.push_back(length > 0 ? Vec3d(sum / length) : Vec3d(0.0));
    }
    return normals;
}

void expect_close(const std::vector<Vec3>& got, const std::vector<Vec3d>& expected, double tolerance) {
    ASSERT_EQ(got.size(), expected.size());
    for (std::size_t v = 0; v < got.size(); ++v)
        EXPECT_LE(glm::length(Vec3d(got[v]) - expected[v]), tolerance) << "vertex " << v;
}

TEST(Normals, AgreeWithASlowSumWhateverTheScaleAndPlace) {
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const Mesh mesh = random_soup(random, 60, 150);
    const auto triangles = triangulate(mesh).triangles;
    const std::vector<Vec3d> expected = slow_normals(mesh, triangles);
    expect_close(area_weighted_normals(mesh, triangles), expected, 1e-6);
    for (const double scale : {1e-300, 1e-200, 1e-7, 1e7, 1e200, 1e300}) {
        Mesh scaled = mesh;
        for (Vec3d& p : scaled.positions)
            p *= scale;
        expect_close(area_weighted_normals(scaled, triangles), expected, 1e-6);
    }
    Mesh far = mesh;
    for (Vec3d& p : far.positions)
        p += Vec3d(1e6, -2e6, 3e6);
    expect_close(area_weighted_normals(far, triangles), slow_normals(far, triangles), 1e-6);
}

TEST(Normals, ATriangleTinyBesideTheMeshHasAUnitNormal) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {3e-40, 1e-40, 0}, {1e-40, 0, 2e-40}, {1e40, 0, 0}};
    mesh.add_face(Triangle{0, 1, 2});
    const Vec3 expected = glm::normalize(Vec3(2, -6, -1));
    EXPECT_LE(glm::length(area_weighted_normals(mesh, triangulate(mesh).triangles)[0] - expected), 1e-6f);
}

TEST(Normals, ADirectionHasUnitLengthWhateverItsOwn) {
    for (const double length : {4.94065645841246544e-324, 1e-310, 1e-160, 1.0, 1e160, 1.7e308})
        EXPECT_EQ(unit_or_zero(length * Vec3d(0, -1, 0)), Vec3(0, -1, 0)) << length;
    EXPECT_EQ(unit_or_zero(Vec3d(0.0)), Vec3(0.0f));
    EXPECT_EQ(unit_or_zero(Vec3d(1.0, std::nan(""), 0.0)), Vec3(0.0f));
    EXPECT_EQ(unit_or_zero(Vec3d(1.0, HUGE_VAL, 0.0)), Vec3(0.0f));
}

TEST(Normals, ALargeFaceWeighsMoreThanASmallOne) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {3, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.add_face(Triangle{0, 1, 2}); // area 3/2, along z
    mesh.add_face(Triangle{0, 2, 3}); // area 1/2, along x
    const Vec3 expected = glm::normalize(Vec3(1, 0, 3));
    EXPECT_LE(glm::length(area_weighted_normals(mesh, triangulate(mesh).triangles)[0] - expected), 1e-6f);
}

TEST(Normals, ZeroWhereUnusedOrCancelled) {
    Mesh mesh = tetrahedron();
    mesh.positions.emplace_back(0.3, 0.3, 0.3); // no face
    for (const double x : {5.1, 6.3, 5.7})
        mesh.positions.emplace_back(x, 0.7 * x * x, 0.1 + x);
    mesh.add_face(Triangle{5, 6, 7}); // a sheet and its back
    mesh.add_face(Triangle{7, 6, 5});
    mesh.positions.insert(mesh.positions.end(), {{8, 0, 0}, {9, 1, 0}, {10, 2, 0}});
    mesh.add_face(Triangle{8, 9, 10}); // no area
    const auto normals = area_weighted_normals(mesh, triangulate(mesh).triangles);
    for (std::size_t v = 0; v < normals.size(); ++v)
        EXPECT_NEAR(glm::length(normals[v]), v < 4 ? 1.0 : 0.0, 1e-6) << "vertex " << v;
}

TEST(Normals, SurfelsTakeTheFileNormalsAndFillTheirGaps) {
    Mesh mesh = tetrahedron();
    mesh.normals = {{0, 0, 1}, {0, 0, 0}, {2, 0, 0}, {0, NAN, 0}};
    const auto triangles = triangulate(mesh).triangles;
    const Frame frame = frame_of(mesh.box());
    const auto angle = angle_weighted_normals(mesh, triangles), area = area_weighted_normals(mesh, triangles);

    const auto automatic = make_surfels(mesh, triangles, frame);
    EXPECT_EQ(automatic[0].normal, Vec3(0, 0, 1));
    EXPECT_EQ(automatic[1].normal, angle[1]);
    EXPECT_EQ(automatic[2].normal, Vec3(1, 0, 0));
    EXPECT_EQ(automatic[3].normal, angle[3]);

    const auto file = make_surfels(mesh, triangles, frame, NormalSource::file);
    EXPECT_EQ(file[0].normal, Vec3(0, 0, 1));
    EXPECT_FALSE(file[1].has_normal());
    EXPECT_FALSE(file[3].has_normal());

    const auto weighted = make_surfels(mesh, triangles, frame, NormalSource::area);
    const auto by_angle = make_surfels(mesh, triangles, frame, NormalSource::angle);
    for (std::size_t v = 0; v < 4; ++v) {
        EXPECT_EQ(weighted[v].normal, area[v]);
        EXPECT_EQ(weighted[v].position, frame.to_unit(mesh.positions[v]));
        EXPECT_EQ(by_angle[v].normal, angle[v]);
    }
}

// Each corner of a box has three right angles, however its sides are cut into triangles and whatever their areas are.
TEST(Normals, AngleWeightsDoNotDependOnTheTriangulation) {
    for (const int n : {1, 2, 3}) {
        const Mesh box = test::box_mesh({1.0, 2.0, 5.0}, n);
        const std::vector<Vec3> normals = angle_weighted_normals(box, triangulate(box).triangles);
        int corners = 0;
        for (std::size_t v = 0; v < normals.size(); ++v) {
            const Vec3d p = box.positions[v] / Vec3d(1.0, 2.0, 5.0), size = glm::abs(p);
            const Vec3d on(size.x > 0.999, size.y > 0.999, size.z > 0.999);
            EXPECT_LT(glm::length(Vec3d(normals[v]) - glm::normalize(on * p)), 1e-6) << n << ", " << v;
            corners += on == Vec3d(1.0);
        }
        EXPECT_EQ(corners, 8);
    }
}

TEST(Normals, AskingForFileNormalsThatAreNotThereNamesTheMend) {
    const Mesh mesh = tetrahedron();
    try {
        make_surfels(mesh, triangulate(mesh).triangles, frame_of(mesh.box()), NormalSource::file);
        FAIL() << "no error";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("--normals angle"), std::string::npos);
    }
}

TEST(Normals, VerticesThatAreNotFiniteHaveNoNormalAndSpoilNoOther) {
    Mesh mesh = tetrahedron();
    const Frame frame = frame_of(mesh.box());
    const auto clean = make_surfels(mesh, triangulate(mesh).triangles, frame, NormalSource::area);
    mesh.positions.emplace_back(NAN, 0, 0);
    mesh.positions.emplace_back(0, 0, INFINITY);
    mesh.normals.assign(6, Vec3(0, 1, 0));
    mesh.add_face(Triangle{0, 1, 4});
    mesh.add_face(Triangle{0, 1, 5});
    const auto triangles = triangulate(mesh).triangles;
    for (const NormalSource source : {NormalSource::automatic, NormalSource::file, NormalSource::area}) {
        const auto surfels = make_surfels(mesh, triangles, frame, source);
        for (std::size_t v = 4; v < 6; ++v) {
            EXPECT_EQ(surfels[v].position, Vec3(0.0f));
            EXPECT_FALSE(surfels[v].has_normal());
        }
    }
    const auto surfels = make_surfels(mesh, triangles, frame, NormalSource::area);
    for (std::size_t v = 0; v < 4; ++v)
        EXPECT_EQ(surfels[v].normal, clean[v].normal);
}

TEST(Normals, TheNumberOfThreadsChangesNoBit) {
    std::mt19937 random(1);
    const Mesh mesh = random_soup(random, 100000, 200000);
    const auto triangles = triangulate(mesh).triangles;
    const auto many = area_weighted_normals(mesh, triangles);
    const ThreadLimit one(1);
    EXPECT_EQ(area_weighted_normals(mesh, triangles), many);
}

}
}
