#include "alcove/occlusion/methods/reference/classic.h"

#include "alcove/field/primitives.h"
#include "alcove/occlusion/estimator.h"
#include "reference_scene.h"

#include <gtest/gtest.h>

namespace alcove {
namespace {

TEST(Classic, IsOneOnAPlaneWhateverTheSamples) {
    const std::vector<Surfel> surfels(10, Surfel{{0.3f, 0.0f, -0.7f}, {0, 1, 0}});
    for (const int samples : {2, 5, 17})
        for (const float ao : evaluate_ao(surfels, Plane{}, Classic{.radius = 0.5f, .samples = samples}))
            EXPECT_NEAR(ao, 1.0f, 1e-6f);
}

TEST(Classic, MoreSamplesTendToTheIntegral) {
    const Union corner(Plane{}, Plane{{1, 0, 0}, 0.0f});
    const std::vector<Surfel> surfels{{{0.05f, 0, 0}, {0, 1, 0}}};
    const auto ao = [&](int samples) {
        return evaluate_ao(surfels, corner, Classic{.radius = Classic::reference_radius, .samples = samples}).front();
    };
    // The weighted mean of h - min(h, 0.05) over the heights, times the sum of five weights.
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
        const float near = evaluate_ao(surfels, corner, Classic{.radius = 0.1f}).front();
        const float wide = evaluate_ao(surfels, corner, Classic{.radius = 0.3f}).front();
        EXPECT_GE(near, last);
        EXPECT_LE(wide, near);
        last = near;
    }
    EXPECT_FLOAT_EQ(last, 1.0f);
}

}
}
