#include "alcove/render/detail/cones.h"

#include "alcove/field/primitives.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace alcove {
namespace {

const Union scene(Sphere{{0.05f, 0.02f, 0.1f}, 0.25f}, Torus{{0.0f, -0.2f, 0.0f}, 0.35f, 0.05f},
                  Cuboid{{-0.3f, 0.3f, 0.0f}, {0.05f, 0.1f, 0.2f}});

Vec3d random_direction(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return glm::normalize(Vec3d(normal(random), normal(random), normal(random)));
}

TEST(Cones, NoRayOfOneMeetsAnythingOnTheWay) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    double gained = 0.0;
    for (int i = 0; i < 300; ++i) {
        const Vec3d eye = (0.6 + share(random)) * random_direction(random);
        const Vec3d axis = glm::normalize(0.3 * random_direction(random) - glm::normalize(eye));
        Cone cone{axis, 0.002 + 0.05 * share(random), 0.0};
        march_cones(scene, eye, {&cone, 1}, 3.0, 0.0f);
        gained += std::min(cone.travelled, 3.0);
        for (int k = 0; k < 40; ++k) {
            const Vec3d aside = random_direction(random);
            const Vec3d ray = glm::normalize(axis + 0.999 * cone.slope * share(random) * aside);
            for (double t = 0.0; t < std::min(cone.travelled, 3.0); t += 0.01)
                ASSERT_GT(scene.map(Vec3(eye + t * ray)), 0.0f) << t << " of " << cone.travelled;
        }
    }
    EXPECT_GT(gained, 300 * 0.5);
}

TEST(Cones, GoAsFarAsOneRayWouldWhereTheyAreThin) {
    Cone cone{{0, 0, -1}, 1e-6, 0.0};
    march_cones(Sphere{{0, 0, 0}, 0.25f}, {0, 0, 1}, {&cone, 1}, 3.0, 0.0f);
    EXPECT_NEAR(cone.travelled, 0.75, 1e-4);
    Cone passing{{0, 1, 0}, 1e-6, 0.0};
    march_cones(Sphere{{0, 0, 0}, 0.25f}, {0, 0, 1}, {&passing, 1}, 3.0, 0.0f);
    EXPECT_GE(passing.travelled, 3.0);
}

TEST(Cones, KeepAMarginAndStayWhereTheyAreInside) {
    Cone cone{{0, 0, -1}, 1e-6, 0.0};
    march_cones(Sphere{{0, 0, 0}, 0.25f}, {0, 0, 1}, {&cone, 1}, 3.0, 0.1f);
    EXPECT_NEAR(cone.travelled, 0.65, 1e-4);
    Cone inside{{0, 0, -1}, 1e-3, 0.0};
    march_cones(Sphere{{0, 0, 0}, 0.25f}, {0, 0, 0.1}, {&inside, 1}, 3.0, 0.0f);
    EXPECT_EQ(inside.travelled, 0.0);
}

}
}
