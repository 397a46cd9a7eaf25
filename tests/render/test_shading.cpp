#include "alcove/render/shading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace alcove {
namespace {

TEST(Shading, IsTheFormulaOfItsSource) {
    std::mt19937 random(3);
    std::normal_distribution<double> coordinate;
    std::uniform_real_distribution<double> share(0.0, 1.0);
    const auto direction = [&] {
        return glm::normalize(Vec3d(coordinate(random), coordinate(random), coordinate(random)));
    };
    for (int i = 0; i < 500; ++i) {
        const Vec3d up = direction(), light = direction(), n = direction();
        const double ao = share(random);
        Lighting lighting;
        lighting.up = Vec3(up);
        lighting.toward_key = Vec3(light);
        lighting.key = {1.0f, 0.5f, 0.25f};
        lighting.sky = {0.2f, 0.3f, 0.5f};
        lighting.ground = {0.1f, 0.4f, 0.3f};
        const Vec3 color =
            shade(lighting, {.color = Vec3(1.0f)}, {.normal = Vec3(n), .ao = static_cast<float>(ao)});
        // direct + ambient·ao·(½ + ½ n_y) + bounce·clamp(−n_y)·ao
        const double ny = n.x * up.x + n.y * up.y + n.z * up.z;
        const double facing = std::fmax(0.0, n.x * light.x + n.y * light.y + n.z * light.z);
        for (int c = 0; c < 3; ++c) {
            const double ambient = double(lighting.sky[c]) * ao * (0.5 + 0.5 * ny);
            const double bounce = double(lighting.ground[c]) * std::fmin(1.0, std::fmax(0.0, -ny)) * ao;
            EXPECT_NEAR(color[c], double(lighting.key[c]) * facing + ambient + bounce, 1e-6);
        }
    }
}

TEST(Shading, OcclusionLeavesTheKeyLightAlone) {
    Lighting lighting;
    const Vec3 normal(0.0f, 1.0f, 0.0f);
    const Material white{.color = Vec3(1.0f)};
    const Vec3 buried = shade(lighting, white, {.normal = normal, .ao = 0.0f});
    EXPECT_EQ(buried, lighting.key);
    EXPECT_EQ(shade(lighting, white, {.normal = normal}), lighting.key + lighting.sky);
}

TEST(Shading, DefaultLightingStaysWithinTheDisplay) {
    const Lighting lighting;
    for (int c = 0; c < 3; ++c) {
        EXPECT_LE(lighting.key[c] + lighting.sky[c], 1.0f);
        EXPECT_GT(lighting.ground[c], 0.0f);
    }
}

TEST(Srgb, MatchesTheStandard) {
    // Values of IEC 61966-2-1, from its inverse: ((s + 0.055)/1.055)^2.4 above 0.04045, s/12.92 below.
    for (int code = 0; code <= 255; ++code) {
        const double s = code / 255.0;
        const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
        EXPECT_NEAR(srgb_encoded(static_cast<float>(linear)), s, 2e-6);
    }
    EXPECT_EQ(srgb_encoded(-1.0f), 0.0f);
    EXPECT_NEAR(srgb_encoded(7.0f), 1.0f, 1e-6f);
}

}
}
