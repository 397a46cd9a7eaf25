#include "alcove/render/renderer.h"

#include "alcove/base/parallel.h"
#include "alcove/field/primitives.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace alcove {
namespace {

const Vec3 toward_sun = glm::normalize(Vec3(1.0f, 0.8f, -0.6f));
const Union scene(Plane{{0, 1, 0}, -0.2f}, Sphere{{0, 0, 0}, 0.15f},
                  Capsule{{0.2f, 0, 0.2f}, {0.2f, 0.3f, 0.2f}, 0.04f});

/// Surfels on the ground around the shapes.
std::vector<Surfel> ground(int side) {
    std::vector<Surfel> surfels;
    for (int i = 0; i < side; ++i)
        for (int k = 0; k < side; ++k)
            surfels.push_back({{static_cast<float>(i) / static_cast<float>(side) - 0.7f, -0.2f,
                                static_cast<float>(k) / static_cast<float>(side) - 0.5f},
                               {0, 1, 0}});
    return surfels;
}

/// The formula transcribed in double precision, for one ray.
double transcribed(const Vec3& from, const SoftShadow& shadow) {
    double light = 1.0, t = double(shadow.begin);
    while (t <= double(shadow.end)) {
        const Vec3d p = Vec3d(from) + t * Vec3d(toward_sun);
        const double d = std::fmin(std::fmin(p.y + 0.2, glm::length(p) - double(0.15f)),
                                   double(Capsule{{0.2f, 0, 0.2f}, {0.2f, 0.3f, 0.2f}, 0.04f}.map(Vec3(p))));
        light = std::fmin(light, std::fmax(0.0, double(shadow.sharpness) * d / t));
        if (light < 1e-3)
            return 0.0;
        t += std::fmax(d, 1e-4);
    }
    return light;
}

TEST(SoftShadow, IsTheFormulaOfItsSource) {
    for (const float sharpness : {4.0f, 8.0f, 32.0f}) {
        const SoftShadow shadow{.sharpness = sharpness};
        const std::vector<Surfel> surfels = ground(40);
        const std::vector<float> light = soft_shadows(surfels, scene, toward_sun, shadow);
        int dark = 0, between = 0;
        for (std::size_t i = 0; i < surfels.size(); ++i) {
            const double expected = transcribed(surfels[i].position, shadow);
            EXPECT_NEAR(light[i], expected, 2e-3);
            dark += expected == 0.0;
            between += expected > 0.0 && expected < 1.0;
        }
        EXPECT_GT(dark, 50);
        EXPECT_GT(between, 20);
    }
}

TEST(SoftShadow, IsBlackInTheCoreAndOneFarAway) {
    // Directly behind the ball, and where the rays pass far above it.
    const Vec3 behind = -0.16f * toward_sun, open(-0.65f, -0.2f, -0.45f);
    const std::vector<Surfel> surfels{{behind + Vec3(0.0f, -0.1f, 0.0f), toward_sun}, {open, {0, 1, 0}}};
    const std::vector<float> light = soft_shadows(surfels, Sphere{{0, 0, 0}, 0.15f}, toward_sun);
    EXPECT_EQ(light[0], 0.0f);
    EXPECT_EQ(light[1], 1.0f);
}

TEST(SoftShadow, WhatFacesAwayIsDarkAndWhatHasNoNormalIsNot) {
    const std::vector<Surfel> surfels{{{0, 0, 0}, -toward_sun}, {{0, 0, 0}, Vec3(0.0f)}};
    const std::vector<float> light = soft_shadows(surfels, Plane{{0, 1, 0}, -10.0f}, toward_sun);
    EXPECT_EQ(light[0], 0.0f);
    EXPECT_EQ(light[1], 1.0f);
    EXPECT_TRUE(soft_shadows({}, Plane{}, toward_sun).empty());
}

TEST(SoftShadow, ThreadsDoNotMatter) {
    const std::vector<Surfel> surfels = ground(120);
    const auto with = [&](unsigned threads) {
        const ThreadLimit limit(threads);
        return soft_shadows(surfels, scene, toward_sun);
    };
    EXPECT_EQ(with(1), with(2));
}

}
}
