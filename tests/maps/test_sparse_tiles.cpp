/// Maps with so many texels that most are interpolated between others, and the charts within which they are
/// interpolated.
#include "alcove/maps/detail/charts.h"
#include "alcove/maps/detail/open_tile.h"
#include "alcove/maps/maps.h"

#include "shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alcove {
namespace {

constexpr int width = 1280, height = 1024;

const std::vector<float>& ao_of(const BakedMaps& maps) {
    return maps.tiles.front().layers.front().values;
}

/// A square floor that fills its texture.
Mesh floor_of(double side) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}};
    mesh.add_face(std::array<std::uint32_t, 4>{0, 1, 2, 3});
    mesh.vertex_uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    return mesh;
}

TEST(Charts, AreJoinedByEdgesWithTheSameUvsAndNormals) {
    // A strip of four triangles: a seam in UV space is before the third, a hard edge before the last.
    const std::vector<Triangle> vertices{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}};
    const Vec2 a(0.0f, 0.0f), b(0.1f, 0.0f), c(0.0f, 0.1f), d(0.1f, 0.1f), e(0.0f, 0.2f), f(0.1f, 0.2f),
        far(0.5f, 0.0f);
    const std::vector<UvTriangle> uvs{{a, b, c}, {c, b, d}, {c + far, d + far, e + far}, {e + far, d + far, f + far}};
    const Vec3 up(0, 0, 1), side(1, 0, 0);
    const std::vector<std::array<Vec3, 3>> normals{{up, up, up}, {up, up, up}, {up, up, up}, {side, side, side}};
    EXPECT_EQ(charts_of(vertices, uvs, normals), (std::vector<std::uint32_t>{0, 0, 2, 3}));
}

TEST(SparseTiles, StridesGrowWithTexelsPerTriangleAndWithTheError) {
    EXPECT_EQ(stride_of_samples(250'000, 100, 0.05f), 1);
    EXPECT_EQ(stride_of_samples(300'000, 100, 0.05f), 2);
    EXPECT_EQ(stride_of_samples(3'000'000, 100, 0.05f), 4);
    EXPECT_EQ(stride_of_samples(300'000'000, 100, 0.05f), 4);
    EXPECT_EQ(stride_of_samples(1'300'000, 50'000, 0.05f), 4);
    EXPECT_EQ(stride_of_samples(1'300'000, 50'000, 0.02f), 2);
    EXPECT_EQ(stride_of_samples(1'300'000, 500'000, 0.02f), 1);
}

TEST(SparseTiles, ARoomHasTheClosedFormOfItsWalls) {
    // A floor and a wall at x = 0, much longer than the radius.
    constexpr double radius = 20.0;
    Mesh room;
    room.positions = {{0, 0, -50}, {0, 0, 50}, {100, 0, 50}, {100, 0, -50}, {0, 100, -50}, {0, 100, 50}};
    room.add_face(std::array<std::uint32_t, 4>{0, 1, 2, 3});
    room.add_face(std::array<std::uint32_t, 4>{1, 0, 4, 5});
    room.corner_uvs = {{0, 0}, {0, 1}, {0.5, 1}, {0.5, 0}, {1, 1}, {1, 0}, {0.5, 0}, {0.5, 1}};
    for (const Quality quality : {Quality::draft, Quality::good}) {
        const BakedMaps maps =
            bake_maps(room, {.radius = "20", .quality = quality}, {.width = width, .height = height});
        EXPECT_EQ(maps.texels, std::size_t(width) * height);
        EXPECT_LT(maps.baked.evaluated, 0.3);
        double square = 0.0;
        std::size_t count = 0;
        constexpr int floor_width = width / 2, ends = height / 4; // where the wall is shorter than the radius
        for (int row = ends; row < height - ends; ++row)
            for (int column = 0; column < floor_width; ++column, ++count) {
                const double u = std::min(1.0, (column + 0.5) / floor_width * 100.0 / radius);
                const double truth = 1.0 - (std::acos(u) - u * std::sqrt(1.0 - u * u)) / std::numbers::pi;
                square += std::pow(ao_of(maps)[static_cast<std::size_t>(row * width + column)] - truth, 2);
            }
        EXPECT_LT(std::sqrt(square / static_cast<double>(count)), rmse_of(quality));
    }
}

TEST(SparseTiles, TexelsWhoseNeighboursDifferAreBaked) {
    // Ao on the floor drops to 0 where it enters the box.
    const Mesh floor = floor_of(10.0);
    Mesh box;
    test::add_part(box, test::box_mesh(Vec3d(1.0), 1), 1.0, {5.03, 5.01, 0.5});
    const BakedMaps maps = bake_maps(floor, {.radius = "2", .error = 0.02, .method = "exact", .occluders = {box}},
                                     {.width = width, .height = height});
    EXPECT_LT(maps.baked.evaluated, 0.5);
    std::vector<std::size_t> sample; // texels in even and odd rows and columns
    std::vector<SurfacePoint> points;
    for (std::size_t i = 0; i < ao_of(maps).size(); i += 37) {
        const double u = (static_cast<double>(i % width) + 0.5) / width,
                     v = 1.0 - (static_cast<double>(i / width) + 0.5) / height;
        sample.push_back(i);
        points.push_back({{10.0 * u, 10.0 * v, 0.0}, {0.0f, 0.0f, 1.0f}, 0});
    }
    const Baked truth =
        bake(floor, points,
             {.radius = "2", .method = "exact", .parameters = {{"rays", 512}}, .occluders = {box}, .pilot = false});
    double square = 0.0;
    std::size_t wrong = 0;
    for (std::size_t k = 0; k < sample.size(); ++k) {
        const double error = ao_of(maps)[sample[k]] - truth.ao()[k];
        square += error * error;
        wrong += std::fabs(error) > 0.15;
    }
    EXPECT_LT(std::sqrt(square / static_cast<double>(sample.size())), 0.02);
    EXPECT_LT(wrong, sample.size() / 2000);
}

TEST(SparseTiles, ValuesDoNotDependOnThreads) {
    const Mesh floor = floor_of(10.0);
    Mesh ball;
    test::add_part(ball, test::sphere_mesh(3), 1.0, {5.0, 5.0, 1.1});
    const auto map = [&](unsigned threads) {
        return bake_maps(floor, {.radius = "2", .occluders = {ball}, .threads = threads},
                         {.width = width, .height = height});
    };
    EXPECT_EQ(ao_of(map(1)), ao_of(map(2)));
}

}
}
