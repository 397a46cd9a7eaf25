#include "alcove/mesh/detail/parts.h"

#include "alcove/mesh/diagnose.h"
#include "solids.h"

#include <gtest/gtest.h>

#include <set>

namespace alcove {
namespace {

TEST(Parts, SolidsApartAreParts) {
    Mesh both = together(torus(8, 6), cube(Vec3d(10.0), 2.0));
    both.normals.assign(both.vertex_count(), Vec3(0.0f));
    both.normals[50] = Vec3(0, 0, 1);
    const std::vector<MeshPart> parts = split_parts(both);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(faces_of(parts[0].mesh), faces_of(torus(8, 6)));
    EXPECT_EQ(parts[0].mesh.positions, torus(8, 6).positions);
    EXPECT_EQ(faces_of(parts[1].mesh), faces_of(cube()));
    EXPECT_EQ(parts[1].mesh.positions, cube(Vec3d(10.0), 2.0).positions);
    EXPECT_EQ(parts[1].mesh.normals[2], Vec3(0, 0, 1));
    for (std::uint32_t i = 0; i < 8; ++i)
        EXPECT_EQ(parts[1].vertices[i], 48 + i);
}

TEST(Parts, SeamsDoNotPartButPointsThatTouchDo) {
    EXPECT_EQ(split_parts(split(cube())).size(), 1u);
    // Two cubes that share only a corner, by index or by position, share no edge.
    const Mesh touching = together(cube(), cube(Vec3d(1.0)));
    EXPECT_EQ(split_parts(touching).size(), 2u);
    std::vector<Face> faces = faces_of(touching);
    for (Face& face : faces)
        std::replace(face.begin(), face.end(), 8u, 7u);
    const std::vector<MeshPart> parts = split_parts(with_faces(touching, faces));
    ASSERT_EQ(parts.size(), 2u);
    for (const MeshPart& part : parts)
        EXPECT_EQ(std::count(part.vertices.begin(), part.vertices.end(), 7u), 1);
}

TEST(Parts, AreAsManyAsTheDiagnosisCounts) {
    Mesh mesh = cube();
    for (int i = 1; i < 20; ++i)
        mesh = together(mesh, i % 3 ? cube(Vec3d(0.9 * i), 1.0) : inverted(torus(4, 5)));
    const std::vector<MeshPart> parts = split_parts(mesh);
    EXPECT_EQ(parts.size(), closedness(mesh).components);
    std::set<std::uint32_t> vertices;
    std::size_t faces = 0;
    for (const MeshPart& part : parts) {
        EXPECT_EQ(closedness(part.mesh).components, 1u);
        EXPECT_TRUE(closedness(part.mesh).closed());
        vertices.insert(part.vertices.begin(), part.vertices.end());
        faces += part.mesh.face_count();
    }
    EXPECT_EQ(vertices.size(), mesh.vertex_count());
    EXPECT_EQ(faces, mesh.face_count());
}

TEST(Parts, WhatHasNoSurfaceIsInNone) {
    Mesh mesh = cube();
    mesh.positions.emplace_back(5, 5, 5);
    mesh.positions.emplace_back(NAN, 0, 0);
    mesh.add_face(Face{0, 8, 8});
    mesh.add_face(Face{0, 1, 9});
    const std::vector<MeshPart> parts = split_parts(mesh);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].mesh.face_count(), 6u);
    EXPECT_EQ(parts[0].vertices.size(), 8u);
    EXPECT_TRUE(split_parts(Mesh{}).empty());
}

}
}
