#include "alcove/mesh/detail/clip.h"

#include "alcove/mesh/diagnose.h"
#include "alcove/mesh/triangulate.h"
#include "solids.h"

#include <gtest/gtest.h>

#include <random>

namespace alcove {
namespace {

double area(const Mesh& mesh) {
    double sum = 0.0;
    for (const Triangle& t : triangulate(mesh).triangles)
        sum += 0.5 * glm::length(glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                                            mesh.positions[t[2]] - mesh.positions[t[0]]));
    return sum;
}

Mesh clipped(const Mesh& mesh, const Box& box) {
    return clip(mesh, triangulate(mesh).triangles, box);
}

TEST(Clip, WhatIsInsideStaysAsItIs) {
    const Mesh solid = torus(12, 8);
    const Mesh same = clipped(solid, {Vec3d(-10.0), Vec3d(10.0)});
    EXPECT_EQ(same.face_count(), triangulate(solid).triangles.size());
    EXPECT_EQ(same.vertex_count(), solid.vertex_count());
    EXPECT_TRUE(closedness(same).closed());
    EXPECT_EQ(clipped(solid, {Vec3d(20.0), Vec3d(30.0)}).face_count(), 0u);
}

TEST(Clip, ALargeTriangleIsCutToTheBox) {
    Mesh floor;
    floor.positions = {{-100, 0, -100}, {-100, 0, 300}, {300, 0, -100}};
    floor.add_face(Face{0, 1, 2});
    const Mesh cut = clipped(floor, {{-1, -1, -2}, {3, 1, 1}});
    EXPECT_NEAR(area(cut), 4.0 * 3.0, 1e-12);
    const Box box = cut.box();
    EXPECT_EQ(box.min, Vec3d(-1, 0, -2));
    EXPECT_EQ(box.max, Vec3d(3, 0, 1));
}

/// The areas of the eight clipped octants around any point add up to the whole.
TEST(Clip, NothingIsLostBetweenBoxes) {
    const Mesh solid = torus(9, 7);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> between(-1.0, 1.0);
    for (int round = 0; round < 20; ++round) {
        const Vec3d middle(3.0 * between(random), 3.0 * between(random), between(random));
        double sum = 0.0;
        for (int cell = 0; cell < 8; ++cell) {
            Box box{Vec3d(-10.0), Vec3d(10.0)};
            for (int axis = 0; axis < 3; ++axis)
                (cell >> axis & 1 ? box.min : box.max)[axis] = middle[axis];
            const Mesh part = clipped(solid, box);
            sum += area(part);
            for (const Vec3d& p : part.positions)
                EXPECT_TRUE(glm::all(glm::lessThanEqual(p, box.max)) && glm::all(glm::greaterThanEqual(p, box.min)));
        }
        EXPECT_NEAR(sum, area(solid), 1e-9);
    }
}

/// The result is open only at the sides of the box, as neighbours cut a common edge at the same point.
TEST(Clip, TheRimOfACutLiesOnTheBox) {
    const Mesh cut = clipped(torus(24, 16), {{-10, -10, -10}, {1.234, 0.777, 10}});
    const Diagnosis diagnosis = diagnose(cut);
    EXPECT_EQ(diagnosis.components, 1u);
    EXPECT_EQ(diagnosis.boundary_loops, 2u); // the ends of an arc of the ring
    EXPECT_EQ(diagnosis.flipped_edges, 0u);
}

}
}
