#include "alcove/mesh/detail/gaps.h"
#include "alcove/mesh/detail/join.h"
#include "alcove/mesh/detail/weld.h"
#include "alcove/mesh/diagnose.h"
#include "alcove/mesh/triangulate.h"
#include "solids.h"

#include <gtest/gtest.h>

#include <random>

namespace alcove {
namespace {

Gaps gaps_of(const Mesh& mesh) {
    return find_gaps(mesh, triangulate(mesh).triangles);
}

/// Moves each vertex by up to `distance` along each axis.
Mesh shaken(Mesh mesh, double distance) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> shift(-distance, distance);
    for (Vec3d& p : mesh.positions)
        p += Vec3d(shift(random), shift(random), shift(random));
    return mesh;
}

TEST(WeldWithin, JoinsExactlyTheNear) {
    std::mt19937 random(3);
    std::vector<Vec3d> positions{{NAN, 0, 0}, {NAN, 0, 0}, {INFINITY, 0, 0}, {INFINITY, 0, 0}, {-1e6, 0, 0}};
    for (int place = 0; place < 300; ++place) { // places at least 1 apart, with vertices at most 0.17 apart
        const Vec3d center(place % 10, place / 10 % 10, place / 100);
        for (int copy = 0; copy < 3; ++copy)
            positions.push_back(center + 0.1 / 1024 * Vec3d(random() % 1024, random() % 1024, random() % 1024));
    }
    const auto joined = weld(positions, 0.2);
    for (std::uint32_t v = 0; v < 5; ++v)
        EXPECT_EQ(joined[v], v);
    for (std::uint32_t v = 5; v < positions.size(); ++v)
        EXPECT_EQ(joined[v], v - (v - 5) % 3);
    EXPECT_EQ(weld(positions, 1e-9).back(), positions.size() - 1);
}

TEST(WeldWithin, TakesTheNearestOfTheFirstOnes) {
    EXPECT_EQ(weld(std::vector<Vec3d>{{0, 0, 0}, {1.5, 0, 0}, {0.9, 0, 0}, {0.7, 0, 0}, {2.4, 0, 0}}, 1.0),
              (std::vector<std::uint32_t>{0, 1, 1, 0, 1}));
}

TEST(Gaps, AClosedMeshHasNone) {
    for (const Mesh& mesh : {cube(), torus(20, 10), together(cube(), cube(Vec3d(3.0)))}) {
        const Gaps gaps = gaps_of(mesh);
        EXPECT_TRUE(gaps.repeated.empty());
        EXPECT_EQ(gaps.closable, 0u);
        EXPECT_EQ(gaps.advice(), "");
    }
}

TEST(Gaps, RepeatedVerticesAreFound) {
    const Gaps gaps = gaps_of(split(torus(20, 10)));
    EXPECT_EQ(gaps.repeated.size(), 600u) << "200 quads with 800 corners at 200 places";
    EXPECT_EQ(gaps.closable, 0u) << "exactly equal places need no distance";
}

TEST(Gaps, CornersApartByRoundingAreFoundWithTheirDistance) {
    for (const double size : {1e-6, 1.0, 1e6}) {
        Mesh mesh = split(torus(20, 10));
        for (Vec3d& p : mesh.positions)
            p *= size;
        const Gaps gaps = gaps_of(shaken(mesh, 1e-6 * size));
        EXPECT_EQ(gaps.closable, 800u) << "each of the 400 edges is open twice";
        EXPECT_GT(gaps.distance, 1e-6 * size);
        EXPECT_LT(gaps.distance, 8e-6 * size);
        EXPECT_NE(gaps.advice().find("800 open edges would close if vertices within"), std::string::npos);
    }
}

TEST(Gaps, HolesStayHoles) {
    std::vector<Face> faces = faces_of(torus(40, 20));
    faces.resize(faces.size() - 7);
    const Mesh open = with_faces(torus(40, 20), faces);
    EXPECT_EQ(gaps_of(open).closable, 0u);
    const Gaps gaps = gaps_of(shaken(split(open), 1e-6));
    EXPECT_EQ(gaps.closable, 4 * faces.size() - closedness(open).open_edges);
}

TEST(Join, ClosesWhatRoundingHasOpened) {
    const Mesh whole = torus(20, 10), apart = shaken(split(whole), 1e-6);
    EXPECT_FALSE(closedness(apart).closed());
    const JoinedMesh joined = join_vertices(apart, Length(8e-6));
    EXPECT_EQ(joined.mesh.vertex_count(), whole.vertex_count());
    EXPECT_EQ(joined.mesh.face_count(), whole.face_count());
    EXPECT_TRUE(closedness(joined.mesh).closed());
    ASSERT_EQ(joined.vertex_of.size(), apart.vertex_count());
    for (std::size_t v = 0; v < apart.vertex_count(); ++v)
        EXPECT_LT(glm::distance(joined.mesh.positions[joined.vertex_of[v]], apart.positions[v]), 8e-6);
    EXPECT_TRUE(joined.mesh.warnings.empty());
    EXPECT_TRUE(closedness(join_vertices(apart, Length("0.0001%")).mesh).closed());
}

TEST(Join, VerticesWithNormalsShareOnlyThePlace) {
    Mesh apart = shaken(split(cube()), 1e-6);
    apart.normals.assign(apart.vertex_count(), Vec3(0, 0, 1));
    const JoinedMesh joined = join_vertices(apart, Length(1e-5));
    EXPECT_EQ(joined.mesh.corners, apart.corners);
    EXPECT_EQ(joined.mesh.normals, apart.normals);
    EXPECT_TRUE(closedness(joined.mesh).closed());
}

TEST(Join, WarnsOfFacesThatLoseTheirCorners) {
    const JoinedMesh joined = join_vertices(together(cube(), cube(Vec3d(3.0), 0.001)), Length(0.01));
    ASSERT_EQ(joined.mesh.warnings.size(), 1u);
    EXPECT_TRUE(joined.mesh.warnings[0].starts_with("6 faces have fewer than three corners once vertices are joined"));
    EXPECT_EQ(joined.mesh.face_count(), 12u);
    EXPECT_THROW(join_vertices(cube(), Length(2.0)), InputError);
}

}
}
