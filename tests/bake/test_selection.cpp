/// BakeOptions::faces.
#include "alcove/bake/bake.h"

#include "alcove/bake/detail/selection.h"
#include "alcove/base/types.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace alcove {
namespace {

/// A floor at z = 0 that faces up, and a lid of the same size 0.5 above it that faces down, in groups named `floor` and
/// `lid`.
Mesh floor_and_lid() {
    Mesh mesh;
    for (const double z : {0.0, 0.5})
        for (const auto& [x, y] : {std::pair(0.0, 0.0), {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}})
            mesh.positions.emplace_back(x, y, z);
    mesh.add_face(std::array<std::uint32_t, 4>{0, 1, 2, 3});
    mesh.add_face(std::array<std::uint32_t, 4>{7, 6, 5, 4});
    mesh.groups = {{{"room", "floor"}, 0, false}, {{"room", "lid"}, 1, true}};
    return mesh;
}

std::vector<float> ao(const FaceSelection& faces) {
    return bake(floor_and_lid(), {.radius = "inf", .method = "exact", .parameters = {{"rays", 256}}, .faces = faces})
        .ao();
}

bool all_are(std::span<const float> values, float wanted) {
    return std::all_of(values.begin(), values.end(), [&](float value) { return value == wanted; });
}

TEST(Selection, OnlyBakesOnePartAmongAll) {
    const std::vector<float> all = ao({}), floor = ao({.only = {"floor"}});
    EXPECT_LT(all[0], 0.95f);
    EXPECT_TRUE(std::equal(floor.begin(), floor.begin() + 4, all.begin())); // the lid occludes as before
    EXPECT_TRUE(all_are(std::span(floor).subspan(4), 1.0f));
    const Baked baked = bake(floor_and_lid(), {.method = "exact", .faces = {.only = {"floor"}}});
    EXPECT_EQ(baked.selected, (std::vector<std::uint8_t>{1, 1, 1, 1, 0, 0, 0, 0}));
    EXPECT_TRUE(baked.warnings.empty()) << baked.warnings.front();
}

TEST(Selection, ExcludedPartsDoNotOcclude) {
    const std::vector<float> floor = ao({.exclude = {"lid"}});
    EXPECT_TRUE(all_are(floor, 1.0f));
    const Baked baked = bake(floor_and_lid(), {.radius = "10%", .method = "exact", .faces = {.exclude = {"lid"}}});
    EXPECT_NEAR(baked.radius, 0.1 * std::sqrt(2.0), 1e-6); // the diagonal of the remaining faces
}

TEST(Selection, PartsThatDoNotOccludeAreStillBaked) {
    for (const FaceSelection& faces : {FaceSelection{.no_occlude = {"l?d"}}, FaceSelection{.opaque_only = true}}) {
        const std::vector<float> values = ao(faces), all = ao({});
        EXPECT_TRUE(all_are(std::span(values).first(4), 1.0f));
        EXPECT_TRUE(std::equal(values.begin() + 4, values.end(), all.begin() + 4)); // the floor still occludes the lid
    }
}

TEST(Selection, GridMethodsFollowItToo) {
    const FaceSelection faces{.no_occlude = {"lid"}};
    const std::vector<float> values = bake(floor_and_lid(), {.radius = "50%", .method = "traced", .faces = faces}).ao();
    for (std::size_t v = 0; v < 4; ++v)
        EXPECT_GT(values[v], 0.98f);
    for (std::size_t v = 4; v < 8; ++v)
        EXPECT_LT(values[v], 0.9f);
}

TEST(Selection, PointsReferToTheFacesOfTheWholeMesh) {
    const Mesh mesh = floor_and_lid();
    const SurfacePoint on_lid{{0.5, 0.5, 0.5}, {0, 0, -1}, 1};
    EXPECT_EQ(bake(mesh, std::span(&on_lid, 1), {.radius = "inf", .method = "exact", .faces = {.exclude = {"floor"}}})
                  .ao()[0],
              1.0f);
}

TEST(Selection, NamesThatMatchNothingAreRefused) {
    const auto refusal = [](const Mesh& mesh, const FaceSelection& faces) {
        try {
            bake(mesh, {.faces = faces});
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(refusal(floor_and_lid(), {.only = {"flor"}}), "--only 'flor' matches no name; did you mean 'floor'?");
    EXPECT_EQ(refusal(floor_and_lid(), {.exclude = {"roo*"}}),
              "--exclude leaves no face to bake: exclude less, or name other parts with --only");
    Mesh bare = floor_and_lid();
    bare.groups.clear();
    EXPECT_NE(refusal(bare, {.exclude = {"lid"}}).find("has no named parts"), std::string::npos);
}

TEST(Selection, WildcardsMatch) {
    EXPECT_TRUE(matches("chair.001", "chair*"));
    EXPECT_TRUE(matches("chair.001", "*.00?"));
    EXPECT_TRUE(matches("chair", "*chair*"));
    EXPECT_TRUE(matches("", "*"));
    EXPECT_TRUE(matches("abcbcd", "a*bcd"));
    EXPECT_FALSE(matches("chair", "chai"));
    EXPECT_FALSE(matches("chair", "chair?"));
    EXPECT_FALSE(matches("Chair", "chair"));
    EXPECT_FALSE(matches("a", ""));
}

TEST(Selection, ColoursAreMultipliedInLinearLight) {
    Mesh mesh = floor_and_lid();
    mesh.vertex_colors.assign(8, {188, 255, 0, 77});
    Baked baked;
    baked.attributes = Channel::ao;
    baked.values[Channel::ao].assign(8, 0.5f);
    EXPECT_TRUE(add(mesh, baked, {.color = ColorUse::multiply}));
    EXPECT_EQ(mesh.added_colors[0], (Color{137, 188, 0, 77})); // linear 0.503 and 1, halved
}

}
}
