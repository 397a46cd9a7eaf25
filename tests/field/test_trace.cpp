#include "alcove/field/detail/trace.h"

#include "alcove/field/primitives.h"

#include <gtest/gtest.h>

#include <random>

namespace alcove {
namespace {

const Union scene(Plane{{0, 1, 0}, -0.5f}, Sphere{{0, 0, 0}, 0.3f}, Torus{{0, -0.3f, 0}, 0.6f, 0.05f},
                  Cuboid{{0.5f, 0.2f, 0.1f}, {0.02f, 0.4f, 0.3f}});

RayBatch random_rays() {
    std::mt19937 random(12);
    std::normal_distribution<float> normal;
    RayBatch rays;
    while (rays.count < RayBatch::capacity) {
        const Vec3 origin(normal(random), 0.6f + std::fabs(normal(random)), normal(random));
        const Vec3 target(0.4f * normal(random), 0.4f * normal(random), 0.4f * normal(random));
        if (scene.map(origin) > 0.0f)
            rays.push_back({origin, glm::normalize(target - origin)}, 0.0f);
    }
    return rays;
}

/// The first hit of a ray, with steps of 0.3 times the distance.
float trace_slowly(const Vec3& origin, const Vec3& direction, float far) {
    float t = 0.0f;
    for (float d = 1.0f; t < far && d > 1e-5f; t += 0.3f * d)
        d = scene.map(origin + t * direction);
    return t;
}

TEST(Trace, MeetsTheSurfaceWhereSlowRaysDoWhateverTheRelaxation) {
    const RayBatch start = random_rays();
    const float far = 6.0f;
    for (const float relaxation : {1.0f, 1.2f, 1.6f, 1.9f}) {
        RayBatch rays = start;
        trace(scene, rays, {.far = far, .hit_distance = 1e-5f, .shortest_step = 1e-5f, .relaxation = relaxation});
        int hits = 0;
        for (std::size_t i = 0; i < rays.count; ++i) {
            const float expected =
                trace_slowly({rays.x[i], rays.y[i], rays.z[i]}, {rays.dx[i], rays.dy[i], rays.dz[i]}, far);
            EXPECT_EQ(rays.hit[i], expected < far);
            if (rays.hit[i]) {
                EXPECT_NEAR(rays.travelled[i], expected, 1e-3f);
                ++hits;
            } else {
                EXPECT_GE(rays.travelled[i], far);
            }
        }
        EXPECT_GT(hits, 200);
    }
}

TEST(Trace, RelaxationSavesStepsOfGrazingRays) {
    const auto steps = [](float relaxation) {
        RayBatch rays;
        for (int i = 1; i <= 64; ++i) {
            const float slope = 0.005f * static_cast<float>(i);
            rays.push_back({{0, 0.1f, 0}, glm::normalize(Vec3(1.0f, -slope, 0.0f))}, 0.0f);
        }
        trace(Plane{}, rays, {.far = 100.0f, .max_steps = 10000, .relaxation = relaxation});
        int sum = 0;
        for (std::size_t i = 0; i < rays.count; ++i) {
            EXPECT_TRUE(rays.hit[i]);
            sum += rays.steps[i];
        }
        return sum;
    };
    EXPECT_LT(steps(1.6f), 0.7 * steps(1.0f));
}

}
}
