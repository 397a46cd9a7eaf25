/// Maps of a high-poly surface in the UVs of a low-poly mesh.
#include "alcove/maps/detail/projection.h"
#include "alcove/maps/maps.h"

#include "shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

/// A square of edge 2 at z = 0 that faces up, with UVs over the whole texture.
Mesh low_square() {
    Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.add_face(std::array<std::uint32_t, 4>{0, 1, 2, 3});
    mesh.corner_uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    return mesh;
}

/// A larger square of n × n quads at the heights of a function.
Mesh high_square(int n, const std::function<double(double, double)>& height) {
    Mesh mesh;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const double x = -1.2 + 2.4 * i / n, y = -1.2 + 2.4 * j / n;
            mesh.positions.emplace_back(x, y, height(x, y));
        }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const auto v = static_cast<std::uint32_t>(j * (n + 1) + i), row = static_cast<std::uint32_t>(n + 1);
            mesh.add_face(std::array<std::uint32_t, 4>{v, v + 1, v + 1 + row, v + row});
        }
    return mesh;
}

const MapLayer& layer(const MapTile& tile, MapAttribute attribute) {
    return *std::find_if(tile.layers.begin(), tile.layers.end(),
                         [&](const MapLayer& l) { return l.attribute == attribute; });
}

constexpr int size = 64;

/// The point of the square at a texel.
Vec3d place_of(std::size_t texel) {
    return {-1.0 + 2.0 * (static_cast<double>(texel % size) + 0.5) / size,
            1.0 - 2.0 * (static_cast<double>(texel / size) + 0.5) / size, 0.0};
}

MapOptions options_with(std::vector<Mesh> high) {
    MapOptions options{.width = size, .height = size};
    options.high = std::move(high);
    options.surface = EnumSet<MapAttribute>(MapAttribute::normal) | MapAttribute::height | MapAttribute::position |
                      MapAttribute::object;
    return options;
}

const BakeOptions nothing{.attributes = ChannelSet()};

TEST(Projection, HeightNormalAndPositionOfAWave) {
    const auto wave = [](double x, double y) { return 0.1 * std::sin(3.0 * x) + 0.02 * y; };
    const BakedMaps maps = bake_maps(low_square(), nothing, options_with({high_square(200, wave)}));
    EXPECT_EQ(maps.texels, static_cast<std::size_t>(size * size));
    EXPECT_EQ(maps.misses, 0u);
    EXPECT_GT(maps.reach, 0.12);
    const MapTile& tile = maps.tiles[0];
    double angle = 0.0;
    for (std::size_t i = 0; i < size * size; ++i) {
        const Vec3d p = place_of(i);
        ASSERT_NEAR(layer(tile, MapAttribute::height).values[i], wave(p.x, p.y), 1e-3);
        ASSERT_EQ(layer(tile, MapAttribute::object).values[i], 1.0f);
        const float* position = &layer(tile, MapAttribute::position).values[3 * i];
        ASSERT_NEAR(position[0], p.x, 1e-5);
        ASSERT_NEAR(position[2], wave(p.x, p.y), 1e-3);
        // The tangent space of the square is that of the scene.
        const float* n = &layer(tile, MapAttribute::normal).values[3 * i];
        const Vec3d truth = glm::normalize(Vec3d(-0.3 * std::cos(3.0 * p.x), -0.02, 1.0));
        angle += std::acos(std::min(1.0, glm::dot(truth, Vec3d(n[0], n[1], n[2]))));
    }
    EXPECT_LT(angle / (size * size), 0.01);
}

TEST(Projection, TheFirstOutwardFaceCountsAndObjectsAreNumbered) {
    const auto at = [](double z) { return [z](double, double) { return z; }; };
    Mesh upside_down = high_square(4, at(0.2));
    std::reverse(upside_down.corners.begin(), upside_down.corners.end()); // its back is above, so rays pass through it
    MapOptions options = options_with({high_square(4, at(-0.1)), high_square(4, at(0.05)), upside_down});
    options.reach = Length("0.5");
    const BakedMaps maps = bake_maps(low_square(), nothing, options);
    for (std::size_t i = 0; i < size * size; ++i) {
        ASSERT_NEAR(layer(maps.tiles[0], MapAttribute::height).values[i], 0.05f, 1e-5f);
        ASSERT_EQ(layer(maps.tiles[0], MapAttribute::object).values[i], 2.0f);
    }
    EXPECT_NEAR(maps.reach, 0.5, 1e-6);
}

TEST(Projection, MissesAreCountedAndFilledFromTheirNeighbours) {
    // The surface drops out of reach on the right half.
    MapOptions options = options_with({high_square(240, [](double x, double) { return x < 0.001 ? 0.1 : -5.0; })});
    options.reach = Length("0.3");
    const BakedMaps maps = bake_maps(low_square(), nothing, options);
    EXPECT_NEAR(static_cast<double>(maps.misses), size * size / 2, size * 2);
    EXPECT_EQ(maps.misses + maps.texels, static_cast<std::size_t>(size * size));
    const MapTile& tile = maps.tiles[0];
    for (std::size_t i = 0; i < size * size; ++i)
        ASSERT_NEAR(layer(tile, MapAttribute::height).values[i], 0.1f, 0.02f);
    EXPECT_EQ(tile.coverage[size - 1], Coverage::miss);
    EXPECT_EQ(tile.coverage[0], Coverage::face);
    MapOptions far = options_with({high_square(4, [](double, double) { return 50.0; })});
    far.reach = Length("0.3");
    EXPECT_THROW(bake_maps(low_square(), nothing, far), InputError);
}

TEST(Projection, AoIsThatOfTheHighSurface) {
    // A floor far below the square, beside a wall: the closed form at the floor.
    const Mesh low = low_square();
    Mesh high;
    high.positions = {{0, -50, -1}, {50, -50, -1}, {50, 50, -1}, {0, 50, -1}, {0, -50, 50}, {0, 50, 50}};
    high.add_face(std::array<std::uint32_t, 4>{0, 1, 2, 3});
    high.add_face(std::array<std::uint32_t, 4>{3, 5, 4, 0}); // faces +x
    MapOptions options{.width = size, .height = size};
    options.high = {high};
    options.reach = Length("2");
    constexpr double radius = 0.6;
    const BakedMaps maps = bake_maps(low, {.radius = "0.6"}, options);
    double square = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < size * size; ++i)
        if (const Vec3d p = place_of(i); p.x > 0.0) {
            const double u = std::min(1.0, p.x / radius);
            const double truth = 1.0 - (std::acos(u) - u * std::sqrt(1.0 - u * u)) / std::numbers::pi;
            square += std::pow(layer(maps.tiles[0], MapAttribute::ao).values[i] - truth, 2);
            ++count;
        }
    EXPECT_LT(std::sqrt(square / static_cast<double>(count)), 0.02);
}

TEST(Projection, ASphereProjectsOntoAFinerOne) {
    const Mesh low = test::sphere_mesh(3), high = test::sphere_mesh(6);
    const Projection projection(high, NormalSource::automatic);
    std::vector<ProjectedFrom> from;
    for (std::size_t f = 0; f < low.face_count(); ++f) {
        const auto face = low.face(f);
        ProjectedFrom point;
        for (const std::uint32_t v : face)
            point.position += low.positions[v] / 3.0;
        point.direction = Vec3(glm::normalize(point.position));
        from.push_back(point);
    }
    const double reach = projection.reach_for(from);
    EXPECT_GT(reach, 0.005);
    EXPECT_LT(reach, 0.1); // five times the depth of the facets
    for (ProjectedFrom& point : from)
        point.front = reach;
    const std::vector<ProjectedTo> to = projection.project(from, reach);
    for (std::size_t i = 0; i < to.size(); ++i) {
        ASSERT_TRUE(to[i].hit);
        EXPECT_NEAR(glm::length(to[i].point.position), 1.0, 3e-4);
        EXPECT_NEAR(to[i].height, 1.0 - glm::length(from[i].position), 3e-4);
        EXPECT_GT(glm::dot(to[i].point.normal, from[i].direction), 0.999f);
    }
}

TEST(Projection, ACageLooksInItsOwnDirection) {
    // Beside a step of the high mesh, a ray along the normal meets the top of the step. A ray from a slanted cage meets
    // the side of the step.
    const Mesh low = low_square();
    const std::vector<Mesh> high{high_square(48, [](double x, double) { return x < 0.0 ? 0.0 : 0.2; })};
    MapOptions options = options_with(high);
    options.reach = Length(0.5);
    options.cage = low;
    for (Vec3d& p : options.cage->positions)
        p += Vec3d(0.4, 0.0, 0.4); // seen from the right, at 45 degrees
    const BakedMaps maps = bake_maps(low, {.radius = "10%"}, options);
    const std::vector<float>& positions = layer(maps.tiles[0], MapAttribute::position).values;
    for (std::size_t i = 0; i < maps.tiles[0].coverage.size(); ++i) {
        if (maps.tiles[0].coverage[i] != Coverage::face)
            continue;
        // The ray runs through the texel in the direction (1, 0, 1).
        const Vec3d place = place_of(i);
        EXPECT_NEAR(positions[3 * i] - place.x, positions[3 * i + 2] - place.z, 1e-5);
        EXPECT_NEAR(positions[3 * i + 1], place.y, 1e-5);
    }
    options.cage->positions.pop_back();
    options.cage->face_begin = {0};
    options.cage->corners.clear();
    EXPECT_THROW(bake_maps(low, {}, options), InputError);
}

}
}
