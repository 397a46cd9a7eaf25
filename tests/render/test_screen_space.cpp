#include "alcove/render/detail/image_method.h"
#include "alcove/render/detail/screen_space.h"

#include "alcove/base/parallel.h"
#include "alcove/field/primitives.h"
#include "alcove/occlusion/detail/directions.h"
#include "alcove/render/detail/march_steps.h"
#include "alcove/render/renderer.h"
#include "exact_subject.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alcove {
namespace {

constexpr ImageSize size{120, 90};

Renderable corner() {
    return renderable_of(Union(Plane{}, Plane{{1.0f, 0.0f, 0.0f}, -0.2f}), {-0.2f, -0.01f, -0.5f}, {0.6f, 0.5f, 0.5f});
}
const Camera camera = camera_at({0.7f, 0.6f, 0.2f}, {-0.1f, 0.05f, 0.0f}, size, 25.0);

/// The formula transcribed for one pixel in double precision, from depths and normals only.
double transcribed(const DepthBuffer& seen, std::size_t pixel, double radius, int samples, double bias) {
    const auto place = [&](std::size_t i) {
        const double x = static_cast<double>(i % 120) + 0.5, y = static_cast<double>(i / 120) + 0.5;
        const Vec3d ray = camera.direction(x, y);
        return camera.eye() + ray * (double(seen.depth[i]) / glm::dot(ray, camera.forward()));
    };
    const Vec3d p = place(pixel);
    const Basis basis(seen.normal[pixel]);
    const std::uint32_t random = hash(static_cast<std::uint32_t>(pixel));
    int counted = 0, hidden = 0;
    for (int i = 0; i < samples; ++i) {
        // A cosine-weighted lattice on the hemisphere, rotated per pixel.
        const Vec2 uv = fibonacci_point(i, samples, unit_interval(random), unit_interval(hash(random)));
        const Vec3 local = cosine_hemisphere(uv.x, uv.y);
        if (double(local.z) <= std::sin(bias * 3.14159265358979 / 180.0))
            continue;
        ++counted;
        const double length =
            radius * std::sqrt(1.0 - double(unit_interval(hash(random + static_cast<std::uint32_t>(i)))));
        const Vec3d q = p + length * Vec3d(basis.to_world(local));
        const Vec3d on_screen = camera.project(q);
        if (on_screen.x < 0 || on_screen.y < 0 || on_screen.x >= 120 || on_screen.y >= 90)
            continue;
        const std::size_t other = static_cast<std::size_t>(on_screen.y) * 120 + static_cast<std::size_t>(on_screen.x);
        // The segment from the eye to q crosses the tangent plane of that pixel at this share of its length.
        const Vec3d n(seen.normal[other]), to_q = q - camera.eye();
        const double share = glm::dot(n, place(other) - camera.eye()) / glm::dot(n, to_q);
        const bool edge_on = glm::dot(n, to_q) >= -0.05 * glm::length(to_q);
        const double stored = edge_on ? double(seen.depth[other]) : share * on_screen.z;
        hidden += stored < on_screen.z - 1e-4 * radius && stored > on_screen.z - radius;
    }
    return 1.0 - static_cast<double>(hidden) / counted;
}

TEST(ScreenSpace, IsTheFormulaOfItsSource) {
    const DepthBuffer seen = look(corner(), camera);
    const ScreenSpace method{.samples = 24, .bias = 8.0f, .blur = 0};
    const double radius = 0.15 * frame.diagonal;
    const std::vector<float> ao = method(seen, radius);
    double darkest = 1.0, sum = 0.0;
    int off = 0;
    for (std::size_t i = 0; i < ao.size(); ++i) {
        ASSERT_TRUE(seen.seen(i));
        // Rounding may move a sample across the edge of a pixel or the limit of a check.
        const double error = std::fabs(double(ao[i]) - transcribed(seen, i, radius, 24, 8.0));
        off += error > 1e-5;
        EXPECT_LE(error, 2.0 / 20.0);
        darkest = std::fmin(darkest, double(ao[i]));
        sum += double(ao[i]);
    }
    EXPECT_LE(off, static_cast<int>(ao.size()) / 200);
    EXPECT_LT(darkest, 0.5);
    EXPECT_GT(sum / static_cast<double>(ao.size()), 0.6);
}

TEST(ScreenSpace, AnOpenPlaneIsOpen) {
    const Renderable plane = renderable_of(Plane{}, {-0.6f, -0.01f, -0.6f}, {0.6f, 0.01f, 0.6f});
    const Camera above = camera_at({0.3f, 0.5f, 0.9f}, {0.0f, 0.0f, 0.0f}, size, 25.0);
    for (int blur = 0; blur <= 2; ++blur)
        for (const float ao : ScreenSpace{.blur = blur}(plane, above))
            EXPECT_GE(ao, 0.999f);
}

TEST(ScreenSpace, BilateralBlurSmoothsAPlaneAndKeepsTheEdgeOfAnother) {
    // A step in depth partly occludes the surface behind it.
    const int w = size.width;
    DepthBuffer seen{camera_at({0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.0f}, size, 25.0), {}, {}};
    for (int i = 0; i < w * size.height; ++i) {
        seen.depth.push_back(i % w < w / 2 ? 4.0f : 5.0f);
        seen.normal.emplace_back(0, 0, 1);
    }
    // Compares only how the blurs treat the step in depth.
    const auto rough = ScreenSpace{.blur = 0}(seen, 1.5), soft = ScreenSpace{.blur = 1}(seen, 1.5),
               sharp = ScreenSpace{.blur = 2}(seen, 1.5);
    const auto at = [&](const std::vector<float>& ao, int x) { // mean of a column
        double sum = 0.0;
        for (int y = 10; y < size.height - 10; ++y)
            sum += double(ao[static_cast<std::size_t>(y * w + x)]);
        return sum / (size.height - 20);
    };
    const double step = std::fabs(at(rough, w / 2) - at(rough, w / 2 - 1));
    EXPECT_GT(step, 0.1);
    EXPECT_LT(std::fabs(at(soft, w / 2) - at(soft, w / 2 - 1)), 0.5 * step);
    EXPECT_GT(std::fabs(at(sharp, w / 2) - at(sharp, w / 2 - 1)), 0.8 * step);
    const auto noise = [&](const std::vector<float>& ao) {
        double sum = 0.0;
        for (int y = 20; y < size.height - 20; ++y) {
            const double d = double(ao[static_cast<std::size_t>(y * w + w / 2 + 2)]) - at(ao, w / 2 + 2);
            sum += d * d;
        }
        return sum;
    };
    EXPECT_LT(noise(sharp), 0.3 * noise(rough));
}

TEST(ScreenSpace, ThreadsDoNotMatterAndWhatIsNotSeenIsOpen) {
    const Renderable ball = renderable_of(Sphere{{0, 0, 0}, 0.2f}, Vec3(-0.2f), Vec3(0.2f));
    const Camera view = camera_at({0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.0f}, size);
    const auto with = [&](unsigned threads) {
        const ThreadLimit limit(threads);
        return ScreenSpace{}(ball, view);
    };
    EXPECT_EQ(with(1), with(2));
    EXPECT_EQ(with(2).front(), 1.0f);
}

TEST(MarchSteps, CountsTheStepsOfAPlainRay) {
    // Straight toward a plane: one step to the surface, and one to detect the hit.
    const Renderable plane = renderable_of(Plane{{0, 0, 1}, 0.0f}, {-1.0f, -1.0f, -0.01f}, {1.0f, 1.0f, 0.01f});
    const Camera view = camera_at({0.0f, 0.0f, 0.5f}, {0.0f, 0.0f, 0.0f}, {3, 3}, 1e-3);
    for (const float ao : MarchSteps{.max_steps = 11}(plane, view))
        EXPECT_FLOAT_EQ(ao, 1.0f - 2.0f / 10.0f);
    // Parallel to the plane, the ray never hits.
    const Camera along = camera_at({0.0f, 0.0f, 0.001f}, {1.0f, 0.0f, 0.001f}, {3, 3}, 1e-3);
    for (const float ao : MarchSteps{.max_steps = 11}(plane, along))
        EXPECT_EQ(ao, 0.0f);
}

TEST(ImageMethods, AreFoundByTheirNamesAndDrawn) {
    EXPECT_EQ(find_image_method("classic"), nullptr);
    for (const ImageMethod& method : image_methods()) {
        EXPECT_EQ(find_image_method(method.name), &method);
        RenderOptions options{.samples = 3, .settings = {.radius = 0.1f}, .image_method = &method, .passes = Pass::ao};
        const Image image = render(corner(), camera, options);
        const std::vector<float> expected = method.occlusion(corner(), camera, options.settings);
        for (std::size_t i = 0; i < image.pixels(); ++i)
            EXPECT_NEAR(image.ao[i], expected[i] * image.alpha[i], 1e-6f);
    }
}

}
}
