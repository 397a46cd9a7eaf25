#include "alcove/mesh/mesh.h"

#include "alcove/base/types.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alcove {
namespace {

TEST(Mesh, BoxLeavesOutVerticesThatAreNotFinite) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 2, 2}, {NAN, 0, 0}, {0, INFINITY, 0}};
    EXPECT_DOUBLE_EQ(mesh.box().diagonal(), 3.0);
}

TEST(Mesh, DiagonalKeepsItsDigitsAtTheEndsOfTheRange) {
    for (const double scale : {1e-200, 1.0, 1e200}) {
        Box box;
        box.add({0, 0, 0});
        box.add(scale * Vec3d(1, 2, 2));
        EXPECT_DOUBLE_EQ(box.diagonal() / scale, 3.0);
    }
}

TEST(Mesh, FrameMapsTheBoxToUnitDiagonalAroundTheOrigin) {
    Box box;
    box.add({1e6, 1e6, 1e6});
    box.add({1e6 + 1, 1e6 + 2, 1e6 + 2});
    const Frame frame = frame_of(box);
    const Vec3 low = frame.to_unit(box.min), high = frame.to_unit(box.max);
    EXPECT_NEAR(glm::length(high - low), 1.0, 1e-6);
    EXPECT_NEAR(glm::length(high + low), 0.0, 1e-6);
    EXPECT_NEAR(glm::length(frame.to_scene(high) - box.max), 0.0, 1e-6);
}

TEST(Mesh, ABoxThatNumbersCannotMeasureHasNoFrame) {
    Box box;
    box.add(Vec3d(-1e308));
    box.add(Vec3d(1e308));
    EXPECT_TRUE(std::isinf(box.diagonal()));
    EXPECT_THROW(frame_of(box), InputError);
}

TEST(Mesh, AttributeOfTheSameNameIsReplacedAndOfAnotherLengthRefused) {
    Mesh mesh;
    mesh.positions.resize(2);
    mesh.set_attribute({"ao", 1, {0.f, 0.f}});
    mesh.set_attribute({"ao", 1, {1.f, 1.f}});
    ASSERT_EQ(mesh.attributes.size(), 1u);
    EXPECT_EQ(mesh.find_attribute("ao")->values[1], 1.f);
    EXPECT_THROW(mesh.set_attribute({"bent", 3, {0.f}}), std::invalid_argument);
}

}
}
