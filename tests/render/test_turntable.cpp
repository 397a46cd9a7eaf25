#include "alcove/render/detail/turntable.h"

#include <gtest/gtest.h>

namespace alcove {
namespace {

const Axis axis{{1.0, 2.0, 3.0}, {0.0, 2.0, 0.0}};

TEST(Turntable, TurnsCounterclockwiseAboutTheAxis) {
    EXPECT_NEAR(glm::length(turned(Vec3d(2, 5, 3), axis, 90.0) - Vec3d(1, 5, 2)), 0.0, 1e-12);
    EXPECT_NEAR(glm::length(turned(Vec3d(1, 7, 3), axis, 33.0) - Vec3d(1, 7, 3)), 0.0, 1e-12);
    EXPECT_NEAR(glm::length(turned(Vec3d(2, 5, 4), axis, 360.0) - Vec3d(2, 5, 4)), 0.0, 1e-12);
}

/// A rotated camera projects a rotated point to the same pixel.
TEST(Turntable, TheCameraIsCarriedAround) {
    const Camera camera({4.0, 5.0, 6.0}, {1.0, 2.0, 3.0}, {0.0, 1.0, 0.0}, 40.0, {320, 200});
    for (const double degrees : {0.0, 10.0, 90.0, 200.0})
        for (const Vec3d& p : {Vec3d(1, 2, 3), Vec3d(0, 3, 2), Vec3d(2, 1.5, 3)}) {
            const Vec3d before = camera.project(p);
            const Vec3d after = turned(camera, axis, degrees).project(turned(p, axis, degrees));
            EXPECT_NEAR(glm::length(before - after), 0.0, 1e-9);
        }
}

TEST(Turntable, WhatSeesTheSweptPointsSeesThemInEveryFrame) {
    const std::vector<Vec3d> points{{3.0, 2.0, 3.0}, {1.0, 2.5, 3.0}, {1.0, 1.0, 3.5}};
    const ImageSize size{320, 200};
    const Camera camera = make_camera({}, swept(points, axis), size);
    for (int frame = 0; frame < 24; ++frame)
        for (const Vec3d& p : points) {
            const Vec3d seen = turned(camera, axis, 15.0 * frame).project(p);
            EXPECT_GT(seen.z, 0.0);
            EXPECT_GT(seen.x, 0.0);
            EXPECT_LT(seen.x, size.width);
            EXPECT_GT(seen.y, 0.0);
            EXPECT_LT(seen.y, size.height);
        }
}

}
}
