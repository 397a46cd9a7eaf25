#include "alcove/occlusion/methods/classic.h"

#include "alcove/field/combine.h"
#include "alcove/field/primitives.h"
#include "alcove/occlusion/bake.h"
#include "documents_scene.h"

#include <gtest/gtest.h>

namespace alcove {
namespace {

/// The formula of the document, word for word, in double.
double classic_by_the_document(const test::DocumentsScene& scene, const Vec3& p, const Vec3& n) {
    double occlusion = 0.0, weight = 1.0;
    for (int i = 0; i < 5; ++i) {
        const double h = 0.01 + 0.12 * i / 4.0;
        const double d = scene.distance(Vec3d(p) + h * Vec3d(n));
        occlusion += (h - d) * weight;
        weight *= 0.95;
    }
    return std::fmin(1.0, std::fmax(0.0, 1.0 - 3.0 * occlusion));
}

TEST(Classic, EqualsTheDocumentOnItsScene) {
    const test::DocumentsScene scene;
    const std::vector<Surfel> surfels = scene.surfels(1000);
    const std::vector<float> ao = bake(surfels, scene.field, Classic{.radius = Classic::document_radius});
    int occluded = 0;
    for (std::size_t i = 0; i < surfels.size(); ++i) {
        const double expected = classic_by_the_document(scene, surfels[i].position, surfels[i].normal);
        EXPECT_NEAR(ao[i], expected, 1e-5);
        occluded += expected < 0.9;
    }
    EXPECT_GT(occluded, 20) << "the points must reach the creases for the test to mean anything";
}

TEST(Classic, DoesNotDependOnTheScaleOfTheScene) {
    const test::DocumentsScene scene;
    const std::vector<Surfel> surfels = scene.surfels(300);
    const std::vector<float> unit = bake(surfels, scene.field, Classic{.radius = 0.4f});
    for (const float scale : {1e-3f, 1e3f}) {
        std::vector<Surfel> scaled = surfels;
        for (Surfel& s : scaled)
            s.position *= scale;
        const Transformed<decltype(scene.field)> field{scene.field, glm::mat3(1.0f), scale};
        const std::vector<float> ao = bake(scaled, field, Classic{.radius = 0.4f * scale});
        for (std::size_t i = 0; i < ao.size(); ++i)
            EXPECT_NEAR(ao[i], unit[i], 1e-4);
    }
}

TEST(Classic, IsOneOnAPlaneWhateverTheSamples) {
    const std::vector<Surfel> surfels(10, Surfel{{0.3f, 0.0f, -0.7f}, {0, 1, 0}});
    for (const int samples : {2, 5, 17})
        for (const float ao : bake(surfels, Plane{}, Classic{.radius = 0.5f, .samples = samples}))
            EXPECT_NEAR(ao, 1.0f, 1e-6f);
}

TEST(Classic, MoreSamplesTendToTheIntegral) {
    const Union corner(Plane{}, Plane{{1, 0, 0}, 0.0f});
    const std::vector<Surfel> surfels{{{0.05f, 0, 0}, {0, 1, 0}}};
    const auto ao = [&](int samples) {
        return bake(surfels, corner, Classic{.radius = Classic::document_radius, .samples = samples}).front();
    };
    // The weighted mean of h - min(h, 0.05) over the heights, times what five weights come to.
    double integral = 0.0, weights = 0.0;
    for (int i = 0; i < 100000; ++i) {
        const double t = (i + 0.5) / 100000, h = 0.01 + 0.12 * t, weight = std::pow(0.95, 4 * t);
        integral += weight * (h - std::fmin(h, 0.05));
        weights += weight;
    }
    const double five = 1 + 0.95 + std::pow(0.95, 2) + std::pow(0.95, 3) + std::pow(0.95, 4);
    const double expected = 1.0 - 3.0 * five * integral / weights;
    EXPECT_NEAR(ao(1000), expected, 1e-3);
    EXPECT_NEAR(ao(5), expected, 0.05);
}

TEST(Classic, DarkensTowardACornerAndWithTheRadius) {
    const Union corner(Plane{}, Plane{{1, 0, 0}, 0.0f});
    float last = 0.0f;
    for (const float x : {0.01f, 0.03f, 0.06f, 0.1f, 0.3f}) {
        const std::vector<Surfel> surfels{{{x, 0, 0}, {0, 1, 0}}};
        const float near = bake(surfels, corner, Classic{.radius = 0.1f}).front();
        const float wide = bake(surfels, corner, Classic{.radius = 0.3f}).front();
        EXPECT_GE(near, last);
        EXPECT_LE(wide, near);
        last = near;
    }
    EXPECT_FLOAT_EQ(last, 1.0f);
}

}
}
