#include "alcove/render/camera.h"

#include "alcove/base/types.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace alcove {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

std::vector<Vec3d> corners(const Box& box) {
    std::vector<Vec3d> result;
    for (int i = 0; i < 8; ++i)
        result.push_back({i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z});
    return result;
}

double angle(const Vec3d& a, const Vec3d& b) {
    return std::acos(glm::dot(a, b) / (glm::length(a) * glm::length(b)));
}

TEST(Camera, CenterRayRunsFromTheEyeToTheTarget) {
    const Vec3d eye(3.0, -2.0, 5.0), target(-1.0, 4.0, 0.5);
    const Camera camera(eye, target, {0.0, 1.0, 0.0}, 35.0, {640, 480});
    const Vec3d view = glm::normalize(target - eye);
    EXPECT_NEAR(glm::length(camera.direction(320.0, 240.0) - view), 0.0, 1e-14);
    const Vec3d seen = camera.project(target);
    EXPECT_NEAR(seen.x, 320.0, 1e-10);
    EXPECT_NEAR(seen.y, 240.0, 1e-10);
    EXPECT_NEAR(seen.z, glm::length(target - eye), 1e-12);
}

TEST(Camera, FieldOfViewIsAcrossTheWidth) {
    for (const ImageSize size : {ImageSize{1280, 720}, ImageSize{300, 900}}) {
        const Camera camera({0.0, 0.0, 4.0}, {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 50.0, size);
        const double middle = 0.5 * size.height;
        EXPECT_NEAR(angle(camera.direction(0.0, middle), camera.direction(size.width, middle)), 50.0 * degree, 1e-12);
        EXPECT_NEAR(camera.fov(), 50.0, 1e-12);
        EXPECT_NEAR(camera.screen_window_width(), 2.0 * std::tan(25.0 * degree), 1e-12);
    }
}

TEST(Camera, ImageHasUpAboveAndPixelsAreSquare) {
    // Looks along −z with y up, so +x is to the right.
    const Camera camera({0.0, 0.0, 10.0}, {0.0, 0.0, 0.0}, {0.0, 3.0, 0.0}, 40.0, {200, 100});
    const Vec3d right = camera.project({1.0, 0.0, 0.0}), above = camera.project({0.0, 1.0, 0.0});
    EXPECT_GT(right.x, 100.0);
    EXPECT_NEAR(right.y, 50.0, 1e-10);
    EXPECT_LT(above.y, 50.0);
    EXPECT_NEAR(right.x - 100.0, 50.0 - above.y, 1e-10);
}

TEST(Camera, ProjectingAPointOfARayGivesItsPixelBack) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> coordinate(-10.0, 10.0), share(0.0, 1.0);
    for (int i = 0; i < 200; ++i) {
        const ImageSize size{1 + static_cast<int>(900 * share(random)), 1 + static_cast<int>(900 * share(random))};
        const auto point = [&] { return Vec3d(coordinate(random), coordinate(random), coordinate(random)); };
        const Camera camera(point(), point(), point(), 1.0 + 160.0 * share(random), size);
        const double x = size.width * share(random), y = size.height * share(random);
        const double length = 0.1 + 100.0 * share(random);
        const Vec3d direction = camera.direction(x, y);
        EXPECT_NEAR(glm::length(direction), 1.0, 1e-12);
        const Vec3d seen = camera.project(camera.eye() + length * direction);
        EXPECT_NEAR(seen.x, x, 1e-8 * size.width);
        EXPECT_NEAR(seen.y, y, 1e-8 * size.height);
        EXPECT_NEAR(seen.z, length * glm::dot(direction, camera.forward()), 1e-10 * length);
    }
}

TEST(Camera, MatricesAgreeWithProjection) {
    const Camera camera({3.0, 1.0, -2.0}, {0.0, 0.5, 0.0}, {0.0, 0.0, 1.0}, 60.0, {320, 200});
    for (const Vec3d p : {Vec3d(0.0), Vec3d(0.4, -0.3, 0.8), Vec3d(-2.0, 1.0, 1.0)}) {
        const Vec3d seen = camera.project(p);
        const glm::dvec4 in_camera = camera.world_to_camera() * glm::dvec4(p, 1.0);
        EXPECT_NEAR(in_camera.z, seen.z, 1e-12);
        EXPECT_EQ(in_camera.w, 1.0);
        EXPECT_NEAR(glm::length(Vec3d(in_camera)), glm::length(p - camera.eye()), 1e-12);
        const glm::dvec4 ndc = camera.world_to_ndc() * glm::dvec4(p, 1.0);
        EXPECT_NEAR(ndc.x / ndc.w, seen.x / 320.0, 1e-12);
        EXPECT_NEAR(ndc.y / ndc.w, seen.y / 200.0, 1e-12);
    }
}

TEST(Camera, UpAlongTheViewIsReplaced) {
    for (const Vec3d up : {Vec3d(0.0, 1.0, 0.0), Vec3d(0.0, -1.0, 0.0), Vec3d(0.0, 0.0, 1.0)}) {
        const Camera camera(5.0 * up, Vec3d(0.0), up, 40.0, {100, 100});
        EXPECT_NEAR(glm::length(camera.up()), 1.0, 1e-12);
        EXPECT_NEAR(glm::dot(camera.up(), camera.forward()), 0.0, 1e-12);
    }
}

TEST(Camera, EyeAtTheTargetIsRefused) {
    EXPECT_THROW(Camera({1.0, 2.0, 3.0}, {1.0, 2.0, 3.0}, {0.0, 1.0, 0.0}, 40.0, {10, 10}), InputError);
}

TEST(AutomaticCamera, ContainsTheBoxAndFillsTheImage) {
    const Box boxes[] = {
        {{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}},    {{0.0, 0.0, 0.0}, {10.0, 0.1, 0.2}},
        {{500.0, -3.0, 7.0}, {501.0, 40.0, 8.0}}, {{1e6, 1e6, 1e6}, {1e6 + 1e-3, 1e6 + 2e-3, 1e6 + 1e-3}},
        {{1e20, 2e20, 1e20}, {3e20, 3e20, 2e20}}, {{-1.0, 0.0, -1.0}, {1.0, 0.0, 1.0}}};
    for (const Box& box : boxes)
        for (const ImageSize size : {ImageSize{1280, 720}, ImageSize{200, 600}})
            for (const Vec3d up : {Vec3d(0.0, 1.0, 0.0), Vec3d(0.0, 0.0, 1.0), Vec3d(-1.0, 0.2, 0.1)})
                for (const double fov : {5.0, 40.0, 120.0}) {
                    const std::vector<Vec3d> points = corners(box);
                    const Camera camera = make_camera({.up = up, .fov = fov}, points, size);
                    double left = 1.0, right = 0.0, top = 1.0, bottom = 0.0;
                    for (const Vec3d& p : points) {
                        const Vec3d seen = camera.project(p);
                        EXPECT_GT(seen.z, 0.0);
                        left = std::min(left, seen.x / size.width);
                        right = std::max(right, seen.x / size.width);
                        top = std::min(top, seen.y / size.height);
                        bottom = std::max(bottom, seen.y / size.height);
                    }
                    EXPECT_GE(std::min(left, top), 0.049);
                    EXPECT_LE(std::max(right, bottom), 0.951);
                    // To fill the image with a wide field of view, the eye would have to pass the nearest point.
                    if (fov <= 40.0) {
                        EXPECT_NEAR(std::max(right - left, bottom - top), 0.9, 1e-3);
                    }
                    // Looks from above, with `up` upward.
                    EXPECT_LT(glm::dot(camera.forward(), up), 0.0);
                    EXPECT_GT(glm::dot(camera.up(), up), 0.0);
                }
}

TEST(AutomaticCamera, KeepsWhatIsGiven) {
    const std::vector<Vec3d> points = corners({{-1.0, -1.0, -1.0}, {1.0, 1.0, 3.0}});
    const Camera from_eye = make_camera({.eye = Vec3d(7.0, 0.0, 1.0)}, points, {100, 100});
    EXPECT_EQ(from_eye.eye(), Vec3d(7.0, 0.0, 1.0));
    EXPECT_NEAR(glm::length(from_eye.forward() - Vec3d(-1.0, 0.0, 0.0)), 0.0, 1e-12);
    const Vec3d target(0.5, 0.5, 0.5);
    const Camera at_target = make_camera({.look_at = target}, points, {100, 100});
    const Vec3d seen = at_target.project(target);
    EXPECT_NEAR(seen.x, 50.0, 1e-9);
    EXPECT_NEAR(seen.y, 50.0, 1e-9);
}

}
}
