#include "alcove/render/renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace alcove {
namespace {

/// Random inputs of shading.
struct Case {
    Lighting lighting;
    Material material;
    Place place;

    explicit Case(std::mt19937& random) {
        std::normal_distribution<float> normal;
        std::uniform_real_distribution<float> share(0.0f, 1.0f);
        const auto direction = [&] { return glm::normalize(Vec3(normal(random), normal(random), normal(random))); };
        const auto color = [&] { return Vec3(share(random), share(random), share(random)); };
        lighting = {direction(), direction(), color(), color(), color()};
        material = {color(), color(), color(), share(random), share(random)};
        place = {direction(), direction(), share(random), share(random), share(random)};
    }
};

/// The formulas of the reference, transcribed in double precision.
double transcribed(const Case& c, int channel) {
    const auto dot = [](const Vec3& a, const Vec3& b) {
        return double(a.x) * double(b.x) + double(a.y) * double(b.y) + double(a.z) * double(b.z);
    };
    const double ny = dot(c.place.normal, c.lighting.up);
    const double ao = double(c.place.ao) * double(c.material.occlusion);
    const double diffuse = std::fmax(0.0, dot(c.place.normal, c.lighting.toward_key)) * double(c.lighting.key[channel]);
    const double shadow = double(c.place.shadow), ambient = double(c.lighting.sky[channel]);
    double light = 0.0;
    if (c.lighting.use == OcclusionUse::ambient)
        light = diffuse * shadow + ambient * ao;
    if (c.lighting.use == OcclusionUse::everything)
        light = (diffuse * shadow + ambient) * ao;
    if (c.lighting.use == OcclusionUse::sky)
        light = diffuse * shadow + ambient * ao * (0.5 + 0.5 * ny);
    light += std::fmin(1.0, std::fmax(0.0, -ny)) * ao * double(c.lighting.ground[channel]);
    const double edge = std::fmin(1.0, std::fmax(0.0, (double(c.place.convexity) - 0.5) / 0.5));
    double color = double(c.material.color[channel]);
    if (c.material.edge_color)
        color = color * (1.0 - edge) + double((*c.material.edge_color)[channel]) * edge;
    const double mirrored = std::pow(1.0 - std::fmax(0.0, dot(c.place.to_eye, c.place.normal)), 5.0) * ao;
    return color * light + double(c.material.subsurface[channel]) * (0.05 + 0.95 * ao) +
           double(c.material.reflection) * mirrored * ambient;
}

TEST(Shading, IsTheFormulasOfItsSource) {
    std::mt19937 random(3);
    for (int i = 0; i < 600; ++i) {
        Case c(random);
        c.lighting.use = static_cast<OcclusionUse>(i % 3);
        if (i % 2)
            c.material.edge_color.reset();
        const Vec3 color = shade(c.lighting, c.material, c.place);
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(color[channel], transcribed(c, channel), 2e-6);
    }
}

TEST(Shading, EdgesTakeTheirColourAboveFlatAlone) {
    EXPECT_EQ(edge_share(0.0f), 0.0f);
    EXPECT_EQ(edge_share(0.5f), 0.0f);
    EXPECT_FLOAT_EQ(edge_share(0.75f), 0.5f);
    EXPECT_EQ(edge_share(1.0f), 1.0f);
}

TEST(Shading, BuriedPlacesKeepATwentiethOfTheirSubsurfaceLight) {
    EXPECT_FLOAT_EQ(subsurface(0.0f), 0.05f);
    EXPECT_FLOAT_EQ(subsurface(1.0f), 1.0f);
}

TEST(Shading, TheEnvironmentIsMirroredAtGrazingAngles) {
    const Vec3 up(0.0f, 1.0f, 0.0f);
    EXPECT_EQ(fresnel(up, up, 1.0f), 0.0f);
    EXPECT_EQ(fresnel(up, {1.0f, 0.0f, 0.0f}, 0.5f), 0.5f);
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
    // The inverse transfer function of the standard (srgb1999): ((s + 0.055)/1.055)^2.4 above 0.04045, else s/12.92.
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
