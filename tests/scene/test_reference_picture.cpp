/// The image of the reference scene, pixel by pixel against the reference formulas.
#include "alcove/scene/scene.h"
#include "reference_scene.h"
#include "transcriptions.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alcove {
namespace {

using test::Axes;
using test::Distance;

constexpr ImageSize size{320, 180};

struct Formula {
    const char* method;
    double radius; ///< reference radius
    std::function<double(const Distance&, const Vec3d&, const Vec3d&)> transcription;
};

std::vector<Formula> formulas() {
    using namespace test;
    return {
        {"classic", 0.13, classic},
        {"exponential", 1.0, [](const auto& d, auto& p, auto& n) { return exponential(d, p, n, 1.0); }},
        {"decay", 1.0, [](const auto& d, auto& p, auto& n) { return decay(d, p, n, 0.2); }},
        {"multiplicative", 0.6, multiplicative},
        {"multiscale", 6.4, multiscale},
        {"jittered", 4.0, jittered},
        {"hemisphere_random", 4.01,
         [](const auto& d, auto& p, auto& n) { return hemisphere_random(d, p, n, Axes::world, 0.0); }},
        {"hemisphere", 1.0, [](const auto& d, auto& p, auto& n) { return hemisphere(d, p, n, Axes::world, 32); }},
        {"fibonacci", 0.11, [](const auto& d, auto& p, auto& n) { return fibonacci(d, p, n, Axes::world); }},
    };
}

struct Picture {
    BuiltScene built;
    Camera camera;
    Image image;
};

Picture draw(const std::string& method, double radius) {
    Scene scene = read_scene(ALCOVE_DATA "/documents.toml");
    scene.size = size;
    scene.samples = 1;
    scene.occlusion.method = &find_method(method);
    scene.occlusion.radius = {radius, Length::Unit::scene};
    BuiltScene built = build_scene(scene);
    const Camera camera = make_camera(scene.camera, built.points, scene.size);
    Image image =
        render(built.renderable, camera, rendering_of(scene, built, camera, standard_passes | Pass::position));
    return {std::move(built), camera, std::move(image)};
}

/// Distance along a camera ray to the scene, scene units; infinite if it misses.
double exact_hit(const test::ReferenceScene& scene, const Vec3d& eye, const Vec3d& direction) {
    double t = 0.0;
    for (int step = 0; step < 100000 && t < 100.0; ++step) {
        const double d = scene.distance(eye + t * direction);
        if (d < 1e-9)
            return t;
        t += d;
    }
    return std::numeric_limits<double>::infinity();
}

class DocumentsPicture : public testing::TestWithParam<Formula> {};

TEST_P(DocumentsPicture, IsShadedAsTheDocumentsSay) {
    const test::ReferenceScene scene;
    const Distance d = [&](const Vec3d& x) { return scene.distance(x); };
    const Image image = draw(GetParam().method, GetParam().radius).image;
    const Vec3d light = glm::normalize(Vec3d(1, 0.8, -0.6)), sky(0.2, 0.3, 0.5);
    double min = 1.0, max = 0.0;
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        if (image.alpha[i] == 0.0f)
            continue;
        const Vec3d p(image.position[i]), n(image.normal[i]);
        const double ao = GetParam().transcription(d, p, n);
        EXPECT_NEAR(image.ao[i], ao, 1.0 / 255.0);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(image.color[i][c], std::fmax(0.0, glm::dot(n, light)) + sky[c] * (0.5 + 0.5 * n.y) * ao,
                        1.0 / 255.0);
        min = std::fmin(min, ao);
        max = std::fmax(max, ao);
    }
    EXPECT_GT(max - min, 0.2);
}

INSTANTIATE_TEST_SUITE_P(All, DocumentsPicture, testing::ValuesIn(formulas()),
                         [](const auto& formula) { return formula.param.method; });

TEST(DocumentsPicture, MeetsTheSurfaceWhereItIs) {
    const test::ReferenceScene scene;
    const Picture picture = draw("classic", 0.13);
    std::size_t hits = 0, near = 0;
    for (std::size_t i = 0; i < picture.image.pixels(); ++i) {
        const auto x = static_cast<double>(i % static_cast<std::size_t>(size.width)) + 0.5;
        const auto y = static_cast<double>(i / static_cast<std::size_t>(size.width)) + 0.5;
        const Vec3d direction = picture.camera.direction(x, y);
        const double t = exact_hit(scene, picture.camera.eye(), direction);
        EXPECT_EQ(std::isfinite(t), picture.image.alpha[i] > 0.0f);
        if (!std::isfinite(t))
            continue;
        ++hits;
        near += glm::length(picture.camera.eye() + t * direction - Vec3d(picture.image.position[i])) < 1e-3;
    }
    EXPECT_GT(hits, 50000u);
    EXPECT_GE(static_cast<double>(near), 0.999 * static_cast<double>(hits));
    RecordProperty("hits", static_cast<int>(hits));
    RecordProperty("near", static_cast<int>(near));
}

/// Rays against the scene in double precision, to which `traced` converges.
TEST(DocumentsPicture, TracedTendsToRaysOfThePreciseScene) {
    const test::ReferenceScene scene;
    const Image image = draw("traced", 1.0).image;
    double sum = 0.0, squares = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < image.pixels(); i += 97) {
        if (image.alpha[i] == 0.0f)
            continue;
        const Vec3d p(image.position[i]), n(image.normal[i]);
        const Vec3d side = glm::normalize(glm::cross(n, std::fabs(n.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)));
        const Vec3d across = glm::cross(n, side);
        int open = 0;
        constexpr int rays = 256;
        for (int r = 0; r < rays; ++r) {
            const double u = (r + 0.5) / rays, turn = 2.0 * 3.14159265358979 * std::fmod(r * 0.6180339887, 1.0);
            const Vec3d direction =
                std::sqrt(u) * (std::cos(turn) * side + std::sin(turn) * across) + std::sqrt(1.0 - u) * n;
            double t = 0.0;
            bool hit = false;
            for (int step = 0; step < 500 && t < 1.0 && !hit; ++step) {
                const double d = scene.distance(p + 1e-3 * n + t * direction);
                hit = d < 1e-6;
                t += d;
            }
            open += !hit;
        }
        const double error = double(image.ao[i]) - double(open) / rays;
        sum += error;
        squares += error * error;
        ++count;
    }
    EXPECT_GT(count, 500);
    EXPECT_LT(std::fabs(sum / count), 0.004);
    EXPECT_LT(std::sqrt(squares / count), 0.04); // 16 rays
}

}
}
