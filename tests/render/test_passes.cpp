#include "alcove/field/primitives.h"
#include "alcove/render/renderer.h"
#include "exact_subject.h"

#include <gtest/gtest.h>

namespace alcove {
namespace {

PassSet everything() {
    PassSet all;
    for (const PassInfo& info : all_passes)
        all = all | info.pass;
    return all;
}

/// A ball and a ring, on a ground.
Renderable ball_and_ring() {
    const Sphere ball{{-0.15f, 0.0f, 0.0f}, 0.12f};
    const Torus ring{{0.2f, -0.08f, 0.0f}, 0.12f, 0.04f};
    Renderable renderable = renderable_of(Union(ball, ring), {-0.3f, -0.12f, -0.2f}, {0.4f, 0.12f, 0.2f});
    renderable.parts = {{ball, {.color = Vec3(1, 0, 0)}}, {ring, {.color = Vec3(0, 1, 0)}}};
    renderable.grounds = {
        {.plane = {{0, 1, 0}, -0.12f}, .whole = 1.0f, .gone = 2.0f, .material = {.color = Vec3(0, 0, 1)}}};
    return renderable;
}

TEST(Passes, EveryObjectHasItsNumberPlaceAndMaterial) {
    const Renderable renderable = ball_and_ring();
    const ImageSize size{120, 90};
    const Camera camera = camera_at({0.1f, 0.5f, 1.1f}, {0.05f, -0.05f, 0.0f}, size);
    RenderOptions options{.samples = 1, .passes = everything()};
    options.lighting.key = options.lighting.ground = Vec3(0.0f);
    const Image image = render(renderable, camera, options);
    std::array<int, 4> seen{};
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        const auto object = static_cast<std::size_t>(image.object[i]);
        ASSERT_LT(object, seen.size());
        ++seen[object];
        if (object == no_object) {
            EXPECT_EQ(image.alpha[i], 0.0f);
            continue;
        }
        const Vec3 p = renderable.frame.to_unit(Vec3d(image.position[i]));
        const float distance =
            object == 3 ? renderable.grounds[0].plane.map(p) : renderable.parts[object - 1].field.map(p);
        EXPECT_NEAR(distance, 0.0f, 1e-4f);
        const Vec3d seen_at = camera.project(Vec3d(image.position[i]));
        EXPECT_NEAR(seen_at.x, static_cast<double>(i % 120) + 0.5, 1e-2);
        EXPECT_NEAR(seen_at.z, double(image.depth[i]), 1e-3);
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(image.color[i][c] > 0.0f, static_cast<std::size_t>(c) + 1 == object);
        if (object == 3) {
            EXPECT_NEAR(image.alpha[i], std::clamp(2.0f - glm::length(p), 0.0f, 1.0f), 1e-4f);
            EXPECT_EQ(image.normal[i], Vec3(0, 1, 0));
        }
    }
    for (const int pixels : seen)
        EXPECT_GT(pixels, 100);
}

TEST(Passes, APassIsTheSameWhateverElseIsAsked) {
    const Renderable renderable = ball_and_ring();
    const Camera camera = camera_at({0.1f, 0.5f, 1.1f}, {0.05f, -0.05f, 0.0f}, {80, 60});
    RenderOptions options{
        .samples = 2, .method = &find_method("classic"), .casts_shadow = true, .passes = everything()};
    const Image all = render(renderable, camera, options);
    for (const PassInfo& info : all_passes) {
        options.passes = info.pass;
        const Image one = render(renderable, camera, options);
        EXPECT_EQ(one.alpha, all.alpha);
        const auto expect_same = [&](Pass pass, const auto& values, const auto& of_all) {
            if (pass == info.pass) {
                EXPECT_EQ(values, of_all) << info.name;
            } else {
                EXPECT_TRUE(values.empty()) << info.name;
            }
        };
        expect_same(Pass::beauty, one.color, all.color);
        expect_same(Pass::ao, one.ao, all.ao);
        expect_same(Pass::convexity, one.convexity, all.convexity);
        expect_same(Pass::shadow, one.shadow, all.shadow);
        expect_same(Pass::steps, one.steps, all.steps);
        expect_same(Pass::depth, one.depth, all.depth);
        expect_same(Pass::normal, one.normal, all.normal);
        expect_same(Pass::position, one.position, all.position);
        expect_same(Pass::object, one.object, all.object);
    }
}

TEST(Passes, LightThatCastsNoShadowsCastsNoneBesideTheirPass) {
    const Renderable renderable = ball_and_ring();
    const Camera camera = camera_at({0.1f, 0.5f, 1.1f}, {0.05f, -0.05f, 0.0f}, {80, 60});
    RenderOptions options{.samples = 1, .passes = everything()};
    options.lighting.toward_key = glm::normalize(Vec3(1, 1, 0.2f));
    const Image all = render(renderable, camera, options);
    options.passes = Pass::beauty;
    EXPECT_EQ(all.color, render(renderable, camera, options).color);
    options.casts_shadow = true;
    EXPECT_NE(all.color, render(renderable, camera, options).color);
}

TEST(Passes, ConvexEdgesTakeTheirColour) {
    Renderable renderable = renderable_of(Cuboid{{0, 0, 0}, {0.2f, 0.2f, 0.2f}}, Vec3(-0.2f), Vec3(0.2f));
    renderable.parts = {{renderable.field, {.color = Vec3(0, 0, 1), .edge_color = Vec3(1, 0, 0)}}};
    const Camera camera = camera_at({0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.0f}, {101, 101}, 40.0);
    RenderOptions options{.samples = 1};
    options.settings.radius = 0.1f;
    const Image image = render(renderable, camera, options);
    const Vec3& middle = image.color[50 * 101 + 50];
    EXPECT_LT(middle.x, 1e-3f);
    EXPECT_GT(middle.z, 0.1f);
    float reddest = 0.0f;
    for (std::size_t x = 0; x < 101; ++x)
        reddest = std::max(reddest, image.color[50 * 101 + x].x);
    EXPECT_GT(reddest, 0.02f);
}

TEST(Passes, SamplesFallWithTheDistance) {
    // As in the reference: 5 at the eye, 2 from 50 units on.
    const FewerSamples fewer{.far_samples = 2, .distance = 50.0f};
    EXPECT_EQ(samples_at(0.0f, 5, fewer), 5);
    EXPECT_EQ(samples_at(25.0f, 5, fewer), 4); // 3.5, rounded up
    EXPECT_EQ(samples_at(26.0f, 5, fewer), 3);
    EXPECT_EQ(samples_at(80.0f, 5, fewer), 2);

    const Renderable renderable = ball_and_ring();
    const Camera camera = camera_at({0.1f, 0.5f, 1.1f}, {0.05f, -0.05f, 0.0f}, {80, 60});
    const auto ao = [&](std::optional<FewerSamples> fewer_samples, double samples) {
        return render(renderable, camera,
                      {.samples = 1,
                       .method = &find_method("classic"),
                       .settings = {.radius = 0.2f, .parameters = {{"samples", samples}}},
                       .fewer = fewer_samples,
                       .passes = Pass::ao})
            .ao;
    };
    EXPECT_EQ(ao(FewerSamples{2, 0.1f}, 5), ao({}, 2)); // everything is far
    EXPECT_EQ(ao(FewerSamples{2, 1e6f}, 5), ao({}, 5)); // everything is near
    const std::vector<float> mixed = ao(FewerSamples{2, 2.0f}, 5), far = ao({}, 2), near = ao({}, 5);
    EXPECT_NE(mixed, far);
    EXPECT_NE(mixed, near);
}

}
}
