#include "alcove/mesh/diagnose.h"

#include "solids.h"

#include <gtest/gtest.h>

namespace alcove {
namespace {

std::ptrdiff_t euler(const Diagnosis& d) {
    return static_cast<std::ptrdiff_t>(d.vertices - d.coincident_vertices - d.unreferenced_vertices) -
           static_cast<std::ptrdiff_t>(d.edges) + static_cast<std::ptrdiff_t>(d.faces);
}

TEST(Diagnose, CubeIsClosedAndOriented) {
    const Diagnosis d = diagnose(cube({5, 6, 7}, 2.0));
    EXPECT_TRUE(d.closed());
    EXPECT_TRUE(d.oriented());
    EXPECT_EQ(d.vertices, 8u);
    EXPECT_EQ(d.faces, 6u);
    EXPECT_EQ(d.quads, 6u);
    EXPECT_EQ(d.triangles + d.larger_polygons, 0u);
    EXPECT_EQ(d.edges, 12u);
    EXPECT_EQ(d.components, 1u);
    EXPECT_EQ(d.closed_components, 1u);
    EXPECT_EQ(d.boundary_edges + d.open_edges + d.boundary_loops + d.non_manifold_edges, 0u);
    EXPECT_EQ(d.non_manifold_vertices + d.flipped_edges + d.inverted_components, 0u);
    EXPECT_EQ(d.degenerate_faces + d.duplicate_faces + d.unreferenced_vertices, 0u);
    EXPECT_EQ(d.non_finite_vertices + d.coincident_vertices, 0u);
    EXPECT_NEAR(d.signed_volume, 8.0, 1e-12);
    EXPECT_EQ(euler(d), 2);
    EXPECT_EQ(describe(d).size(), 1u);
}

TEST(Diagnose, MissingFaceIsOneHole) {
    std::vector<Face> faces = faces_of(cube());
    faces.pop_back();
    const Diagnosis d = diagnose(with_faces(cube(), faces));
    EXPECT_FALSE(d.closed());
    EXPECT_TRUE(d.oriented());
    EXPECT_EQ(d.open_edges, 4u);
    EXPECT_EQ(d.boundary_edges, 4u);
    EXPECT_EQ(d.boundary_loops, 1u);
    EXPECT_EQ(d.closed_components, 0u);
    EXPECT_EQ(d.signed_volume, 0.0);
    faces.erase(faces.begin() + 4); // the opposite one: a tube has two boundary loops
    EXPECT_EQ(diagnose(with_faces(cube(), faces)).boundary_loops, 2u);
    EXPECT_EQ(euler(diagnose(with_faces(cube(), faces))), 0);
}

TEST(Diagnose, CubesThatShareAnEdgeAreNonManifoldThereYetBoundASolid) {
    const Diagnosis d = diagnose(together(cube(), cube({1, 1, 0})));
    EXPECT_EQ(d.non_manifold_edges, 1u);
    EXPECT_EQ(d.coincident_vertices, 2u);
    EXPECT_EQ(d.edges, 23u);
    EXPECT_EQ(d.non_manifold_vertices, 0u);
    EXPECT_EQ(d.components, 1u);
    EXPECT_TRUE(d.closed());
    EXPECT_NEAR(d.signed_volume, 2.0, 1e-12);
}

TEST(Diagnose, CubesThatShareAVertexTouchInAPoint) {
    const Diagnosis d = diagnose(together(cube(), cube({1, 1, 1})));
    EXPECT_EQ(d.non_manifold_vertices, 1u);
    EXPECT_EQ(d.non_manifold_edges, 0u);
    EXPECT_EQ(d.components, 2u);
    EXPECT_TRUE(d.closed());
}

TEST(Diagnose, AWallBetweenTwoCubesLeavesNoConsistentSide) {
    // Two cubes with a common face: three faces meet at each of its four edges.
    Mesh mesh = together(cube(), cube({1, 0, 0}));
    std::vector<Face> faces = faces_of(mesh);
    faces.erase(faces.begin() + 10);
    const Diagnosis d = diagnose(with_faces(mesh, faces));
    EXPECT_EQ(d.non_manifold_edges, 4u);
    EXPECT_EQ(d.unbalanced_edges, 4u);
    EXPECT_EQ(d.odd_edges, 4u);
    EXPECT_EQ(d.open_edges + d.flipped_edges, 0u);
    EXPECT_FALSE(d.closed());
    EXPECT_FALSE(d.watertight());
}

TEST(Diagnose, PartsAreCountedAndTheirVolumesAdded) {
    const Diagnosis d = diagnose(together(tetrahedron(), cube({3, 3, 3}, 2.0)));
    EXPECT_EQ(d.components, 2u);
    EXPECT_EQ(d.closed_components, 2u);
    EXPECT_EQ(d.triangles, 4u);
    EXPECT_EQ(d.quads, 6u);
    EXPECT_NEAR(d.signed_volume, 8.0 + 1.0 / 6.0, 1e-12);
    EXPECT_EQ(euler(d), 4);
}

TEST(Diagnose, InsideOutPartsHaveNegativeVolume) {
    const Diagnosis alone = diagnose(inverted(cube()));
    EXPECT_TRUE(alone.closed());
    EXPECT_TRUE(alone.oriented());
    EXPECT_EQ(alone.inverted_components, 1u);
    EXPECT_NEAR(alone.signed_volume, -1.0, 1e-12);
    EXPECT_EQ(describe(alone).size(), 2u);

    const Diagnosis cavity = diagnose(together(cube({0, 0, 0}, 3.0), inverted(cube({1, 1, 1}, 1.0))));
    EXPECT_EQ(cavity.inverted_components, 1u);
    EXPECT_NEAR(cavity.signed_volume, 26.0, 1e-12);
    EXPECT_EQ(diagnose(together(cube({0, 0, 0}, 3.0), cube({1, 1, 1}, 1.0))).inverted_components, 0u);
}

TEST(Diagnose, TheSenseOfASmallFarPartIsStillSeen) {
    const Mesh far = together(cube({-1e6, 0, 0}), together(cube({1e6, 3e5, 7e5}, 1e-3), cube()));
    EXPECT_EQ(diagnose(far).inverted_components, 0u);
    EXPECT_EQ(diagnose(inverted(far)).inverted_components, 3u);
}

TEST(Diagnose, TwoSidedSheetIsClosedAndEnclosesNothing) {
    Mesh mesh;
    mesh.positions = {{0.1, 0.2, 0.3}, {1.3, 0.7, 0.9}, {0.2, 2.1, 0.4}, {30, 40, 50}};
    mesh.add_face(Face{0, 1, 2});
    mesh.add_face(Face{2, 1, 0});
    const Diagnosis d = diagnose(mesh);
    EXPECT_TRUE(d.closed());
    EXPECT_EQ(d.inverted_components, 0u);
    EXPECT_EQ(d.duplicate_faces, 1u);
}

TEST(Diagnose, OneFlippedFaceFlipsItsEdges) {
    std::vector<Face> faces = faces_of(cube());
    std::reverse(faces[2].begin(), faces[2].end());
    const Diagnosis d = diagnose(with_faces(cube(), faces));
    EXPECT_EQ(d.flipped_edges, 4u);
    EXPECT_EQ(d.open_edges, 0u);
    EXPECT_FALSE(d.oriented());
    EXPECT_FALSE(d.closed());
    EXPECT_TRUE(d.watertight());
}

TEST(Diagnose, MoebiusStripCannotBeOriented) {
    constexpr std::uint32_t steps = 12;
    Mesh mesh;
    for (std::uint32_t i = 0; i < steps; ++i)
        for (const double side : {-0.3, 0.3}) {
            const double u = 2 * std::numbers::pi * i / steps;
            const double r = 1 + side * std::cos(u / 2);
            mesh.positions.emplace_back(r * std::cos(u), r * std::sin(u), side * std::sin(u / 2));
        }
    for (std::uint32_t i = 0; i + 1 < steps; ++i)
        mesh.add_face(Face{2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1});
    mesh.add_face(Face{2 * steps - 2, 1, 0, 2 * steps - 1});
    const Diagnosis d = diagnose(mesh);
    EXPECT_EQ(d.flipped_edges, 1u);
    EXPECT_EQ(d.open_edges, 2 * steps);
    EXPECT_EQ(d.boundary_loops, 1u);
    EXPECT_EQ(euler(d), 0);
}

TEST(Diagnose, BrokenFacesAreCounted) {
    Mesh mesh = cube();
    mesh.positions.insert(mesh.positions.end(), {{9, 9, 9}, {NAN, 0, 0}, {0, -INFINITY, 0}, {0.5, 0, 0}});
    for (const Face& face : {Face{2, 3, 1, 0},          // the first face again
                             Face{1, 3, 2, 0},          // and reversed
                             Face{0, 1}, Face{0, 1, 1}, // fewer than three corners
                             Face{0, 11, 1},            // collinear
                             Face{0, 1, 9}, Face{0, 1, 2, 10}})
        mesh.add_face(face);
    const Diagnosis d = diagnose(mesh);
    EXPECT_EQ(d.duplicate_faces, 2u);
    EXPECT_EQ(d.degenerate_faces, 3u);
    EXPECT_EQ(d.non_finite_vertices, 2u);
    EXPECT_EQ(d.unreferenced_vertices, 1u);
    EXPECT_EQ(d.coincident_vertices, 0u);
    EXPECT_EQ(d.non_manifold_edges, 4u); // around the tripled face
    EXPECT_EQ(d.open_edges, 2u);         // from 0 to 11 and from 11 to 1
}

TEST(Diagnose, ThinFacesAreNotDegenerateAtAnyScale) {
    for (const double scale : {1e-200, 1.0, 1e200}) {
        Mesh mesh;
        mesh.positions = {scale * Vec3d(0, 0, 0), scale * Vec3d(1, 0, 0), scale * Vec3d(0.5, 1e-9, 0),
                          scale * Vec3d(0.25, 0, 0)};
        mesh.add_face(Face{0, 1, 2});
        EXPECT_EQ(diagnose(mesh).degenerate_faces, 0u);
        mesh.add_face(Face{0, 1, 3});
        EXPECT_EQ(diagnose(mesh).degenerate_faces, 1u);
    }
}

TEST(Diagnose, SeamsCloseWhenCoincidentVerticesAreJoined) {
    const Diagnosis d = diagnose(split(cube()));
    EXPECT_TRUE(d.closed());
    EXPECT_EQ(d.vertices, 24u);
    EXPECT_EQ(d.coincident_vertices, 16u);
    EXPECT_EQ(d.boundary_edges, 24u);
    EXPECT_EQ(d.seam_edges(), 24u);
    EXPECT_EQ(d.edges, 12u);
    EXPECT_EQ(d.components, 1u);
    EXPECT_NEAR(d.signed_volume, 1.0, 1e-12);
    EXPECT_EQ(euler(d), 2);
}

TEST(Diagnose, TorusHasTheCharacteristicAndVolumeOfATorus) {
    const Diagnosis d = diagnose(torus(200, 100));
    EXPECT_TRUE(d.closed());
    EXPECT_EQ(euler(d), 0);
    EXPECT_NEAR(d.signed_volume, 6 * std::numbers::pi * std::numbers::pi, 0.1);
}

TEST(Diagnose, NothingIsNotClosed) {
    EXPECT_FALSE(diagnose(Mesh{}).closed());
    EXPECT_EQ(diagnose(Mesh{}).components, 0u);
}

TEST(Diagnose, WordsNameTheCountsAndTheMend) {
    std::vector<Face> faces = faces_of(cube());
    faces.pop_back();
    const auto lines = describe(diagnose(with_faces(cube(), faces)));
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NE(lines[0].find("4 open edges around 1 hole"), std::string::npos);
    EXPECT_NE(lines[0].find("fill"), std::string::npos);
}

}
}
