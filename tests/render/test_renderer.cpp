#include "alcove/render/renderer.h"

#include "alcove/base/parallel.h"
#include "alcove/base/types.h"
#include "alcove/field/primitives.h"
#include "exact_subject.h"
#include "scratch_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace alcove {
namespace {

constexpr float radius = 0.25f; // unit space
const Vec3 center(0.05f, -0.02f, 0.1f);

Renderable sphere() {
    return renderable_of(Sphere{center, radius}, center - radius, center + radius);
}

double covered(const Image& image) {
    double sum = 0.0;
    for (const float a : image.alpha)
        sum += static_cast<double>(a);
    return sum;
}

TEST(Renderer, SphereCoversTheDiscItShould) {
    const Vec3 eye = center + Vec3(0.0f, 0.0f, 1.0f);
    const ImageSize size{300, 260};
    const Camera camera = camera_at(eye, center, size);
    for (const int samples : {1, 4, 9}) {
        const Image image = render(sphere(), camera, {.samples = samples});
        // The tangent cone of a sphere of radius r at distance d has the slope r/√(d² − r²).
        const double slope = radius / std::sqrt(1.0 - double(radius) * radius);
        const double pixels = 0.5 * size.width * slope / std::tan(20.0 * std::numbers::pi / 180.0);
        const double area = std::numbers::pi * pixels * pixels;
        EXPECT_NEAR(covered(image), area, 3e-3 * area);
        const auto middle = static_cast<std::size_t>(130 * 300 + 150);
        EXPECT_EQ(image.alpha[middle], 1.0f);
        EXPECT_EQ(image.alpha.front(), 0.0f);
        EXPECT_EQ(image.depth.front(), far_depth);
        EXPECT_EQ(image.normal.front(), Vec3(0.0f));
    }
}

TEST(Renderer, DepthAndNormalAreThoseOfTheSphere) {
    const Vec3 eye = center + Vec3(0.5f, 0.4f, 0.8f);
    const ImageSize size{121, 91};
    const Camera camera = camera_at(eye, center + 0.05f, size, 35.0);
    const Image image = render(sphere(), camera, {.samples = 1}); // through the centres of the pixels
    const Vec3d middle = frame.to_scene(center);
    const double r = double(radius) * frame.diagonal;
    int hits = 0;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const auto i = static_cast<std::size_t>(y * size.width + x);
            const Vec3d direction = camera.direction(x + 0.5, y + 0.5);
            const Vec3d q = camera.eye() - middle;
            const double b = glm::dot(q, direction), discriminant = b * b - glm::dot(q, q) + r * r;
            if (discriminant < 0.05 * r * r) // a miss, or too grazing to compare
                continue;
            ++hits;
            ASSERT_EQ(image.alpha[i], 1.0f);
            const double length = -b - std::sqrt(discriminant);
            EXPECT_NEAR(image.depth[i], length * glm::dot(direction, camera.forward()), 1e-4 * frame.diagonal);
            const Vec3d normal = (q + length * direction) / r;
            EXPECT_NEAR(glm::length(Vec3d(image.normal[i]) - normal), 0.0, 2e-3);
        }
    EXPECT_GT(hits, 1000);
}

TEST(Renderer, FarEyeSeesTheSame) {
    // A thousand diagonals away, single precision from the eye would lose the surface.
    const ImageSize size{101, 101};
    const Camera camera = camera_at(center + Vec3(0.0f, 0.0f, 1000.0f), center, size, 0.04);
    const Image image = render(sphere(), camera, {.samples = 1});
    const double pixels = 0.5 * size.width * (double(radius) / 1000.0) / std::tan(0.02 * std::numbers::pi / 180.0);
    EXPECT_NEAR(covered(image), std::numbers::pi * pixels * pixels, 0.02 * std::numbers::pi * pixels * pixels);
    EXPECT_NEAR(glm::dot(image.normal[50 * 101 + 50], Vec3(0.0f, 0.0f, 1.0f)), 1.0f, 1e-3f);
}

TEST(Renderer, OpenPlaneIsNotOccluded) {
    const Renderable plane = renderable_of(Plane{}, {-0.4f, -0.01f, -0.4f}, {0.4f, 0.01f, 0.4f});
    const Camera camera = camera_at({0.3f, 0.5f, 0.9f}, {0.0f, 0.0f, 0.0f}, {80, 60}, 15.0);
    const Image image = render(plane, camera, {.method = &find_method("classic")});
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        ASSERT_EQ(image.alpha[i], 1.0f);
        EXPECT_NEAR(image.ao[i], 1.0f, 1e-3f);
    }
}

TEST(Renderer, OcclusionDarkensACornerAndOnlyAmbientLight) {
    const auto corner = Union(Plane{}, Plane{{1.0f, 0.0f, 0.0f}, -0.2f});
    const Renderable renderable = renderable_of(corner, {-0.2f, -0.01f, -0.3f}, {0.4f, 0.4f, 0.3f});
    const Camera camera = camera_at({0.7f, 0.6f, 0.2f}, {-0.1f, 0.05f, 0.0f}, {160, 120}, 20.0);
    const Lighting lighting = studio_lighting(camera, {0.0, 1.0, 0.0});
    RenderOptions options{.samples = 1, .method = &find_method("classic"), .lighting = lighting};
    options.settings.radius = 0.1f;
    const Image image = render(renderable, camera, options);
    const Image open = render(renderable, camera, {.samples = 1, .lighting = lighting});
    float darkest = 1.0f, brightest = 0.0f;
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        ASSERT_EQ(image.alpha[i], 1.0f);
        darkest = std::min(darkest, image.ao[i]);
        brightest = std::max(brightest, image.ao[i]);
        EXPECT_EQ(open.ao[i], 1.0f);
        EXPECT_EQ(image.color[i], shade(lighting, {}, {.normal = image.normal[i], .ao = image.ao[i]}));
        EXPECT_EQ(open.color[i], shade(lighting, {}, {.normal = open.normal[i]}));
    }
    EXPECT_LT(darkest, 0.5f);
    EXPECT_GT(brightest, 0.99f);
}

TEST(Renderer, NothingButTheBoxIsDrawn) {
    const Renderable renderable{Union(Sphere{Vec3(-0.2f, 0.0f, 0.0f), 0.1f}, Sphere{Vec3(0.2f, 0.0f, 0.0f), 0.1f}),
                                frame, renderable_of(Plane{}, {0.09f, -0.1f, -0.1f}, {0.3f, 0.1f, 0.1f}).box};
    const Camera camera = camera_at({0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.0f}, {100, 60}, 50.0);
    const Image image = render(renderable, camera, {});
    double left = 0.0, right = 0.0;
    for (std::size_t i = 0; i < image.pixels(); ++i)
        (i % 100 < 50 ? left : right) += static_cast<double>(image.alpha[i]);
    EXPECT_EQ(left, 0.0);
    EXPECT_GT(right, 100.0);
}

TEST(Renderer, EveryValueIsFiniteEvenWithoutAGradient) {
    struct Flat { // no gradient anywhere
        float map(const Vec3& p) const { return p.z > 0.0f ? 0.01f : -0.01f; }
        float resolution() const { return 0.01f; }
        bool two_sided() const { return true; }
    };
    const Renderable renderable = renderable_of(Flat{}, {-0.3f, -0.3f, -0.3f}, {0.3f, 0.3f, 0.3f});
    const Vec3 eyes[] = {{0.2f, 0.1f, 1.0f}, {0.0f, 0.0f, -0.1f}, {0.3f, 0.3f, 0.0f}};
    for (const Vec3& eye : eyes) {
        const Image image = render(renderable, camera_at(eye, {0.01f, 0.0f, -0.01f}, {40, 30}, 90.0),
                                   {.method = &find_method("traced")});
        for (std::size_t i = 0; i < image.pixels(); ++i) {
            for (int c = 0; c < 3; ++c) {
                EXPECT_TRUE(std::isfinite(image.color[i][c]));
                EXPECT_TRUE(std::isfinite(image.normal[i][c]));
            }
            EXPECT_TRUE(std::isfinite(image.depth[i]));
            EXPECT_GE(image.ao[i], 0.0f);
            EXPECT_LE(image.ao[i], image.alpha[i]);
            EXPECT_TRUE(image.alpha[i] == 0.0f || std::fabs(glm::length(image.normal[i]) - 1.0f) < 1e-4f);
        }
    }
}

// A sheet as grids store it: distances to a plane on both sides, negative behind it at the corners of the cells that
// the plane crosses.
struct Sheet {
    static constexpr float voxel = 0.01f;
    // The plane is slightly tilted against the grid, so that the back of the negative layer has steps.
    static float signed_distance(int x, int y, int z) {
        return (static_cast<float>(z) - 0.1f * static_cast<float>(x) + 0.03f * static_cast<float>(y)) /
               std::sqrt(1.0f + 0.1f * 0.1f + 0.03f * 0.03f);
    }
    static float sample(int x, int y, int z) {
        const float d = signed_distance(x, y, z);
        // Of the samples that share a cell with (x, y, z), this one is furthest in front of the plane.
        const bool crossed = signed_distance(x - 1, y + 1, z + 1) >= 0.0f;
        return voxel * (d < 0.0f && !crossed ? -d : d);
    }
    float map(const Vec3& p) const {
        const Vec3 q = p / voxel, cell = glm::floor(q), t = q - cell;
        float sum = 0.0f;
        for (int i = 0; i < 8; ++i) {
            const int x = i & 1, y = i >> 1 & 1, z = i >> 2;
            sum += (x ? t.x : 1.0f - t.x) * (y ? t.y : 1.0f - t.y) * (z ? t.z : 1.0f - t.z) *
                   sample(int(cell.x) + x, int(cell.y) + y, int(cell.z) + z);
        }
        return sum;
    }
    float resolution() const { return voxel; }
    bool two_sided() const { return true; }
};

TEST(Renderer, SheetSeenFromBehindIsSmooth) {
    const Renderable renderable = renderable_of(Sheet{}, {-0.2f, -0.2f, -0.1f}, {0.2f, 0.2f, 0.1f});
    const Vec3 front = glm::normalize(Vec3(-0.1f, 0.03f, 1.0f));
    for (const float side : {1.0f, -1.0f}) {
        const Camera camera = camera_at({0.1f, 0.2f, side}, {0.0f, 0.0f, 0.0f}, {90, 60}, 15.0);
        const Image image = render(renderable, camera, {.samples = 1});
        for (int y = 0; y < 60; ++y)
            for (int x = 0; x < 90; ++x) {
                const auto i = static_cast<std::size_t>(y * 90 + x);
                ASSERT_EQ(image.alpha[i], 1.0f);
                EXPECT_GT(glm::dot(image.normal[i], side * front), 0.999f);
                const Vec3d direction = camera.direction(x + 0.5, y + 0.5);
                const Vec3d plane = frame.to_scene(Vec3(0.0f));
                const double length = glm::dot(plane - camera.eye(), Vec3d(front)) / glm::dot(direction, Vec3d(front));
                EXPECT_NEAR(image.depth[i], length * glm::dot(direction, camera.forward()),
                            0.1 * double(Sheet::voxel) * frame.diagonal);
            }
    }
}

TEST(Renderer, ThreadsDoNotMatter) {
    const ScratchFolder folder;
    const auto scene = Union(Sphere{center, radius}, Torus{{0.0f, -0.2f, 0.0f}, 0.3f, 0.08f});
    const Renderable renderable = renderable_of(scene, {-0.4f, -0.3f, -0.4f}, {0.4f, 0.4f, 0.4f});
    const Camera camera = camera_at({0.5f, 0.6f, 1.0f}, {0.0f, 0.0f, 0.0f}, {160, 120});
    RenderOptions options{.method = &find_method("traced")};
    options.settings.radius = 0.2f;
    const auto file_with = [&](unsigned threads, const char* name) {
        const ThreadLimit limit(threads);
        write_exr(render(renderable, camera, options), folder / name, {});
        return bytes_of(folder / name);
    };
    const std::string one = file_with(1, "one.exr");
    EXPECT_GT(one.size(), 1000u);
    EXPECT_EQ(one, file_with(2, "two.exr"));
}

TEST(Renderer, APixelOfManySamplesIsDrawnInPieces) {
    // More samples per row than a region holds.
    const ImageSize size{1500, 3};
    const Camera camera = camera_at(center + Vec3(0.0f, 0.0f, 1.0f), center, size);
    const Image many = render(sphere(), camera, {.samples = 1000}), few = render(sphere(), camera, {.samples = 9});
    for (std::size_t i = 0; i < many.pixels(); ++i) {
        EXPECT_NEAR(many.alpha[i], few.alpha[i], 0.2f);
        if (few.alpha[i] == 1.0f) {
            EXPECT_NEAR(many.color[i].x, few.color[i].x, 2e-2f);
        }
    }
}

TEST(Renderer, ProgressRunsToTheEnd) {
    const Camera camera = camera_at(center + Vec3(0.0f, 0.0f, 1.0f), center, {64, 48});
    double last = 0.0;
    render(sphere(), camera, {.method = &find_method("classic")}, [&](double done) {
        EXPECT_GE(done, last);
        last = done;
    });
    EXPECT_EQ(last, 1.0);
}

TEST(Outline, BoundsASurfaceByItsField) {
    const Outline around = outline(Sphere{center, radius}, frame);
    const double cell = frame.diagonal / 64.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = frame.to_scene(center - radius)[axis], high = frame.to_scene(center + radius)[axis];
        EXPECT_LE(around.box.min[axis], low);
        EXPECT_GE(around.box.min[axis], low - 2.0 * cell);
        EXPECT_GE(around.box.max[axis], high);
        EXPECT_LE(around.box.max[axis], high + 2.0 * cell);
    }
    for (const Vec3d& p : around.points)
        EXPECT_NEAR(glm::length(p - frame.to_scene(center)), double(radius) * frame.diagonal, cell);
    EXPECT_THROW(outline(Sphere{Vec3(9.0f), 0.1f}, frame), InputError);
}

}
}
