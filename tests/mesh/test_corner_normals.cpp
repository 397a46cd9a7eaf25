#include "alcove/mesh/detail/corner_normals.h"

#include "alcove/mesh/triangulate.h"
#include "shapes.h"

#include <gtest/gtest.h>

namespace alcove::test {
namespace {

TEST(CornerNormals, BreakAtTheEdgesOfABox) {
    for (const double size : {1e-12, 1.0, 1e12}) {
        const Mesh box = box_mesh(Vec3d(1.0, 0.5, 2.0) * size, 3);
        const std::vector<Triangle> triangles = triangulate(box).triangles;
        const auto normals = corner_normals(box, triangles);
        ASSERT_EQ(normals.size(), triangles.size());
        for (std::size_t f = 0; f < triangles.size(); ++f) {
            const Vec3d a = box.positions[triangles[f][0]] / size, b = box.positions[triangles[f][1]] / size,
                        c = box.positions[triangles[f][2]] / size;
            const Vec3d face = glm::normalize(glm::cross(b - a, c - a));
            for (const Vec3& normal : normals[f])
                EXPECT_NEAR(glm::length(Vec3d(normal) - face), 0.0, 1e-6);
        }
    }
}

TEST(CornerNormals, AreThoseOfTheBallOnABall) {
    const Mesh ball = sphere_mesh(4);
    const std::vector<Triangle> triangles = triangulate(ball).triangles;
    const auto normals = corner_normals(ball, triangles);
    for (std::size_t f = 0; f < triangles.size(); ++f)
        for (std::size_t corner = 0; corner < 3; ++corner)
            EXPECT_GT(glm::dot(Vec3d(normals[f][corner]), ball.positions[triangles[f][corner]]), 0.999);
}

TEST(CornerNormals, TheFilesOwnGoFirst) {
    Mesh box = box_mesh(Vec3d(1.0), 1);
    box.normals.assign(box.positions.size(), glm::normalize(Vec3(1, 2, 3)));
    box.normals.front() = Vec3(0.0f); // missing in the file
    const std::vector<Triangle> triangles = triangulate(box).triangles;
    const auto normals = corner_normals(box, triangles);
    for (std::size_t f = 0; f < triangles.size(); ++f)
        for (std::size_t corner = 0; corner < 3; ++corner)
            EXPECT_EQ(normals[f][corner] == glm::normalize(Vec3(1, 2, 3)), triangles[f][corner] != 0);
}

TEST(CornerNormals, OfCornersComeBeforeThoseOfVertices) {
    Mesh box = box_mesh(Vec3d(1.0), 1);
    box.normals.assign(box.positions.size(), glm::normalize(Vec3(1, 2, 3)));
    for (std::size_t c = 0; c < box.corners.size(); ++c) // a different normal for each corner
        box.corner_normals.push_back(glm::normalize(Vec3(1, static_cast<float>(c), 0)));
    box.corner_normals[0] = Vec3(0.0f); // missing in the file
    const std::vector<Triangle> triangles = triangulate(box).triangles, corners = corners_of_triangles(box);
    const auto normals = corner_normals(box, triangles);
    for (std::size_t f = 0; f < triangles.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(box.corners[corners[f][k]], triangles[f][k]);
            EXPECT_EQ(corners[f][k] / 4, f / 2); // of the same quad
            EXPECT_EQ(normals[f][k], corners[f][k] == 0 ? box.normals[0] : box.corner_normals[corners[f][k]]);
        }
}

TEST(CornerNormals, DegenerateFacesHaveNone) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}};
    const std::vector<Triangle> triangles{{0, 1, 2}, {0, 1, 3}};
    const auto normals = corner_normals(mesh, triangles);
    EXPECT_EQ(normals[1][0], Vec3(0, 0, 1));
    EXPECT_EQ(normals[0][2], Vec3(0, 0, 0));
}

}
}
