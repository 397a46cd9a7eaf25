/// Texture maps: closed forms at texels, and what is counted.
#include "alcove/maps/maps.h"

#include "shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace alcove {
namespace {

/// Gives each face of up to four corners its own cell of a square grid in UV space.
Mesh unwrapped(Mesh mesh, float gap = 0.02f) {
    const auto rows = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(mesh.face_count()))));
    const float cell = 1.0f / static_cast<float>(rows);
    mesh.corner_uvs.clear();
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const Vec2 corner(static_cast<float>(f % rows), static_cast<float>(f / rows));
        constexpr std::array<Vec2, 4> square{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
        for (std::size_t k = 0; k < mesh.face(f).size(); ++k)
            mesh.corner_uvs.push_back(cell * (corner + gap + (1.0f - 2.0f * gap) * square[k]));
    }
    return mesh;
}

const MapLayer& layer(const MapTile& tile, Channel channel) {
    return *std::find_if(tile.layers.begin(), tile.layers.end(),
                         [&](const MapLayer& l) { return l.attribute == attribute_of(channel); });
}

bool has_warning(const BakedMaps& maps, const std::string& part) {
    return std::any_of(maps.baked.warnings.begin(), maps.baked.warnings.end(),
                       [&](const std::string& warning) { return warning.find(part) != std::string::npos; });
}

TEST(Maps, ABoxIsOpenUpToItsEdges) {
    const Mesh box = unwrapped(test::box_mesh(Vec3d(1.0), 1));
    for (const char* method : {"", "exact"}) {
        const BakedMaps maps = bake_maps(box, {.radius = "50%", .method = method}, {.width = 96, .height = 96});
        ASSERT_EQ(maps.tiles.size(), 1u);
        EXPECT_EQ(maps.overlaps, 0u);
        for (const float ao : layer(maps.tiles[0], Channel::ao).values)
            EXPECT_NEAR(ao, 1.0f, 0.01f);
    }
}

TEST(Maps, ARoomHasTheClosedFormOfItsWalls) {
    // A floor and a wall at x = 0, much larger than the radius.
    Mesh room;
    room.positions = {{0, 0, -50}, {0, 0, 50}, {100, 0, 50}, {100, 0, -50}, {0, 100, -50}, {0, 100, 50}};
    room.add_face(std::array<std::uint32_t, 4>{0, 1, 2, 3});
    room.add_face(std::array<std::uint32_t, 4>{1, 0, 4, 5});
    room.corner_uvs = {{0, 0}, {0, 1}, {0.5, 1}, {0.5, 0}, {1, 1}, {1, 0}, {0.5, 0}, {0.5, 1}};
    constexpr double radius = 20.0;
    for (const Quality quality : {Quality::draft, Quality::good, Quality::fine}) {
        const BakedMaps maps = bake_maps(room, {.radius = "20", .quality = quality}, {.width = 256, .height = 16});
        const std::vector<float>& ao = layer(maps.tiles[0], Channel::ao).values;
        double square = 0.0;
        std::size_t count = 0;
        for (std::size_t row = 4; row < 12; ++row) // away from the ends of the edge
            for (std::size_t column = 0; column < 128; ++column, ++count) {
                const double u = std::min(1.0, (static_cast<double>(column) + 0.5) / 128.0 * 100.0 / radius);
                const double truth = 1.0 - (std::acos(u) - u * std::sqrt(1.0 - u * u)) / std::numbers::pi;
                square += std::pow(ao[row * 256 + column] - truth, 2);
            }
        EXPECT_LT(std::sqrt(square / static_cast<double>(count)), rmse_of(quality));
    }
}

TEST(Maps, InsideASphereOcclusionIsTheSameEverywhere) {
    Mesh sphere = test::sphere_mesh(5);
    for (std::size_t f = 0; f < sphere.face_count(); ++f)
        std::reverse(sphere.corners.begin() + sphere.face_begin[f], sphere.corners.begin() + sphere.face_begin[f + 1]);
    const BakedMaps maps = bake_maps(unwrapped(sphere), {.radius = "0.8"}, {.width = 512, .height = 512});
    double square = 0.0;
    std::size_t count = 0;
    const MapTile& tile = maps.tiles[0];
    for (std::size_t i = 0; i < tile.coverage.size(); ++i)
        if (tile.coverage[i] == Coverage::face) {
            square += std::pow(layer(tile, Channel::ao).values[i] - (1.0 - 0.4 * 0.4), 2);
            ++count;
        }
    EXPECT_EQ(count, maps.texels);
    EXPECT_LT(std::sqrt(square / static_cast<double>(count)), 0.02);
}

TEST(Maps, AllAttributesAreBaked) {
    const BakedMaps maps =
        bake_maps(unwrapped(test::box_mesh(Vec3d(1.0), 2)),
                  {.radius = "30%",
                   .method = "exact",
                   .parameters = {{"rays", 256}},
                   .attributes = Channel::ao | Channel::convexity | Channel::bent_normal | Channel::thickness},
                  {.width = 128, .height = 128, .space = MapSpace::object});
    const MapTile& tile = maps.tiles[0];
    ASSERT_EQ(tile.layers.size(), 4u);
    EXPECT_NEAR(maps.thickest, maps.baked.radius, 1e-9);
    for (std::size_t i = 0; i < tile.coverage.size(); ++i) {
        const float* bent = &layer(tile, Channel::bent_normal).values[3 * i];
        if (tile.coverage[i] == Coverage::face) { // along an axis
            EXPECT_NEAR(std::fabs(bent[0]) + std::fabs(bent[1]) + std::fabs(bent[2]), 1.0f, 0.1f);
        }
        EXPECT_GE(layer(tile, Channel::convexity).values[i], 0.45f);
        EXPECT_LE(layer(tile, Channel::thickness).values[i], maps.thickest * 1.0001);
    }
}

TEST(Maps, BentNormalsOfAnOpenSurfaceAreTheNormalInTangentSpace) {
    // A floor beside a wall at x = 0. The UVs of the floor are turned: u runs along z.
    Mesh room;
    room.positions = {{0, 0, -50}, {0, 0, 50}, {100, 0, 50}, {100, 0, -50}, {0, 100, -50}, {0, 100, 50}};
    room.add_face(std::array<std::uint32_t, 4>{0, 1, 2, 3});
    room.add_face(std::array<std::uint32_t, 4>{1, 0, 4, 5});
    room.corner_uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {2, 0}, {2, 1}, {3, 1}, {3, 0}};
    const BakeOptions options{
        .radius = "20", .method = "exact", .parameters = {{"rays", 1024}}, .attributes = Channel::bent_normal};
    const auto bent_at = [&](const MapOptions& map, std::size_t row) {
        const std::vector<float> values = layer(bake_maps(room, options, map).tiles[0], Channel::bent_normal).values;
        const float* v = &values[3 * (row * 64 + 32)];
        return Vec3(v[0], v[1], v[2]);
    };
    const MapOptions tangent{.width = 64, .height = 64};
    MapOptions object = tangent, flipped = tangent;
    object.space = MapSpace::object;
    flipped.flip_green = true;
    EXPECT_NEAR(glm::length(bent_at(tangent, 10) - Vec3(0, 0, 1)), 0.0f, 0.02f); // far from the wall
    EXPECT_NEAR(glm::length(bent_at(object, 10) - Vec3(0, 1, 0)), 0.0f, 0.02f);
    // The last row is next to the wall: the bent normal leans away from it, along +x, which is +v.
    const Vec3 near = bent_at(tangent, 63), in_object = bent_at(object, 63);
    EXPECT_GT(near.y, 0.3f);
    EXPECT_NEAR(near.x, in_object.z, 1e-3f);
    EXPECT_NEAR(near.y, in_object.x, 1e-3f);
    EXPECT_NEAR(near.z, in_object.y, 1e-3f);
    EXPECT_NEAR(glm::length(bent_at(flipped, 63) - near * Vec3(1, -1, 1)), 0.0f, 1e-6f);
}

TEST(Maps, SubsamplesAverageAndCoverTheSameTexels) {
    const Mesh box = unwrapped(test::box_mesh(Vec3d(1.0), 1));
    const BakeOptions options{.radius = "50%", .method = "exact", .ground = true};
    const BakedMaps one = bake_maps(box, options, {.width = 60, .height = 60, .margin = 0}),
                    many = bake_maps(box, options, {.width = 60, .height = 60, .subsamples = 4, .margin = 0});
    EXPECT_EQ(one.tiles[0].coverage, many.tiles[0].coverage);
    double difference = 0.0;
    for (std::size_t i = 0; i < one.tiles[0].coverage.size(); ++i)
        difference = std::max(difference, double(std::fabs(layer(one.tiles[0], Channel::ao).values[i] -
                                                           layer(many.tiles[0], Channel::ao).values[i])));
    EXPECT_LT(difference, 0.15);
}

TEST(Maps, TheMarginLeavesNoBackgroundInMipLevels) {
    const BakedMaps maps = bake_maps(unwrapped(test::box_mesh(Vec3d(1.0), 1), 0.1f), {.method = "exact"},
                                     {.width = 256, .height = 256, .margin = 16});
    const std::vector<Coverage>& coverage = maps.tiles[0].coverage;
    for (std::size_t block = 0; block < 16 * 16; ++block) { // a texel of the mip level of 1/16
        std::size_t faces = 0, background = 0;
        for (std::size_t k = 0; k < 16 * 16; ++k) {
            const Coverage c = coverage[(block / 16 * 16 + k / 16) * 256 + block % 16 * 16 + k % 16];
            faces += c == Coverage::face;
            background += c == Coverage::background;
        }
        EXPECT_TRUE(faces == 0 || background == 0);
    }
    EXPECT_GT(std::count(coverage.begin(), coverage.end(), Coverage::background), 0);
}

TEST(Maps, OverlapsAreBakedOnceAndCounted) {
    Mesh box = test::box_mesh(Vec3d(1.0), 1);
    for (std::size_t f = 0; f < box.face_count(); ++f)
        for (const Vec2& uv : {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)})
            box.corner_uvs.push_back(uv);
    const BakedMaps maps = bake_maps(box, {}, {.width = 32, .height = 32});
    EXPECT_EQ(maps.texels, 1024u);
    EXPECT_EQ(maps.overlaps, 1024u);
    EXPECT_TRUE(has_warning(maps, "1,024 texels are covered by several faces"));
}

TEST(Maps, UdimTilesAreNumberedByTheirCorner) {
    Mesh box = unwrapped(test::box_mesh(Vec3d(1.0), 1));
    for (std::size_t c = 0; c < box.corner_uvs.size(); ++c)
        box.corner_uvs[c] += c < 4 ? Vec2(1, 0) : c < 8 ? Vec2(2, 1) : Vec2(0, 0);
    const BakedMaps all = bake_maps(box, {.method = "exact"}, {.width = 64, .height = 64, .udim = true});
    ASSERT_EQ(all.tiles.size(), 3u);
    EXPECT_EQ(all.tiles[0].udim, 1001);
    EXPECT_EQ(all.tiles[1].udim, 1002);
    EXPECT_EQ(all.tiles[2].udim, 1013);
    const BakedMaps first = bake_maps(box, {.method = "exact"}, {.width = 64, .height = 64});
    EXPECT_EQ(first.tiles.size(), 1u);
    EXPECT_EQ(first.tiles[0].coverage, all.tiles[0].coverage);
    EXPECT_TRUE(has_warning(first, "4 triangles lie partly or wholly outside the texture"));
    EXPECT_FALSE(has_warning(all, "outside the texture"));
    // Rounding at the border adds no tile, and neither does a triangle that only seems to reach a tile.
    Mesh triangle;
    triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.add_face(std::array<std::uint32_t, 3>{0, 1, 2});
    triangle.corner_uvs = {{0, 0}, {1.000001f, 0}, {0, 1.000001f}};
    EXPECT_EQ(bake_maps(triangle, {.method = "exact"}, {.width = 8, .height = 8, .udim = true}).tiles.size(), 1u);
    triangle.corner_uvs = {{0, 0}, {3, 0}, {0, 3}};
    EXPECT_LE(bake_maps(triangle, {.method = "exact"}, {.width = 8, .height = 8, .udim = true}).tiles.size(), 8u);
}

TEST(Maps, MalformedUvsAreCountedOrRefused) {
    const Mesh box = unwrapped(test::box_mesh(Vec3d(1.0), 1));
    const auto with_first = [&](const Vec2& uv) {
        Mesh mesh = box;
        mesh.corner_uvs[0] = uv;
        return bake_maps(mesh, {.method = "exact"}, {.width = 32, .height = 32});
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Vec2& uv : {Vec2(nan, 0), Vec2(0, 1e30f), Vec2(-std::numeric_limits<float>::infinity(), 0)})
        EXPECT_TRUE(has_warning(with_first(uv), "triangles have texture coordinates that are not finite or are far"));
    EXPECT_TRUE(has_warning(with_first(box.corner_uvs[2]), "no area in UV space"));
    Mesh equal = box;
    std::fill(equal.corner_uvs.begin(), equal.corner_uvs.end(), Vec2(0.5f));
    EXPECT_THROW(bake_maps(equal), InputError);
    Mesh outside = box;
    for (Vec2& uv : outside.corner_uvs)
        uv += Vec2(5, 5);
    EXPECT_THROW(bake_maps(outside), InputError);
    EXPECT_THROW(bake_maps(test::box_mesh(Vec3d(1.0), 1)), InputError);
    EXPECT_THROW(bake_maps(box, {}, {.width = 0}), InputError);
    EXPECT_THROW(bake_maps(box, {}, {.width = 20'000}), InputError);
    EXPECT_THROW(bake_maps(box, {}, {.subsamples = 9}), InputError);
    EXPECT_THROW(bake_maps(box, {}, {.margin = -1}), InputError);
    MapOptions endless{.width = 8, .height = 8};
    endless.high = {box};
    endless.reach = Length("inf");
    EXPECT_THROW(bake_maps(box, {}, endless), InputError);
}

TEST(Maps, ValuesDoNotDependOnThreads) {
    const Mesh sphere = unwrapped(test::sphere_mesh(3));
    const auto ao = [&](unsigned threads) {
        const BakedMaps maps =
            bake_maps(sphere, {.radius = "50%", .ground = true, .threads = threads}, {.width = 400, .height = 400});
        return layer(maps.tiles[0], Channel::ao).values;
    };
    EXPECT_EQ(ao(1), ao(3));
}

}
}
