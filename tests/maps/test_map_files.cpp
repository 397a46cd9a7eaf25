/// write_maps(): what other programs read.
#include "alcove/maps/maps.h"
#include "alcove/render/image.h"

#include "png_values.h"
#include "scratch_folder.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace alcove {
namespace {

/// A map of 3 × 2 texels, the last of which is background.
BakedMaps small_maps() {
    BakedMaps maps;
    maps.width = 3;
    maps.height = 2;
    maps.thickest = 2.0;
    maps.tiles.push_back(
        {1001,
         {{MapAttribute::ao, {0.0f, 0.2f, 0.4f, 0.6f, 0.8f, 1.0f}},
          {MapAttribute::bent_normal, {0, 0, 1, 0, 0, 1, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, 0, 0}},
          {MapAttribute::thickness, {0.0f, 0.5f, 1.0f, 1.5f, 2.0f, 0.0f}}},
         {Coverage::face, Coverage::face, Coverage::face, Coverage::face, Coverage::margin, Coverage::background}});
    return maps;
}

TEST(MapFiles, PngsHoldLinearValuesWithoutAColourSpace) {
    const ScratchFolder folder;
    const auto files = write_maps(small_maps(), folder / "map.png");
    ASSERT_EQ(files.size(), 3u);
    EXPECT_EQ(files[0].filename(), "map.png");
    EXPECT_EQ(files[1].filename(), "map_bent_normal.png");
    EXPECT_EQ(files[2].filename(), "map_thickness.png");
    const Png ao = read_png(files[0]), bent = read_png(files[1]), thickness = read_png(files[2]);
    EXPECT_EQ(ao.width, 3u);
    EXPECT_EQ(ao.height, 2u);
    EXPECT_FALSE(ao.has_srgb || ao.has_gamma);
    EXPECT_EQ(ao.color_type, PNG_COLOR_TYPE_GRAY);
    EXPECT_EQ(ao.values, (std::vector<int>{0, 51, 102, 153, 204, 255}));
    EXPECT_EQ(bent.color_type, PNG_COLOR_TYPE_RGB);
    EXPECT_EQ(std::vector<int>(bent.values.begin(), bent.values.begin() + 3), (std::vector<int>{128, 128, 255}));
    EXPECT_EQ(thickness.values, (std::vector<int>{0, 64, 128, 191, 255, 0}));
}

TEST(MapFiles, PngsSayHowTheyWereMade) {
    const ScratchFolder folder;
    BakedMaps maps = small_maps();
    maps.baked.method = "traced";
    maps.baked.radius = 0.25;
    for (const auto& file : write_maps(maps, folder / "map.png")) {
        const Png png = read_png(file);
        EXPECT_TRUE(png.texts.at("Software").starts_with("alcove "));
        EXPECT_EQ(png.texts.at("Comment"), "ambient occlusion by traced, radius 0.25");
    }
}

TEST(MapFiles, TheFirstAttributeHasTheGivenName) {
    const ScratchFolder folder;
    BakedMaps maps = small_maps();
    maps.tiles[0].layers.erase(maps.tiles[0].layers.begin());
    const auto files = write_maps(maps, folder / "map.png");
    ASSERT_EQ(files.size(), 2u);
    EXPECT_EQ(files[0].filename(), "map.png");
    EXPECT_EQ(files[1].filename(), "map_thickness.png");
}

TEST(MapFiles, SixteenBits) {
    const ScratchFolder folder;
    const auto files = write_maps(small_maps(), folder / "map.png", {.depth = MapDepth::sixteen});
    const Png ao = read_png(files[0]);
    EXPECT_EQ(ao.depth, 16);
    EXPECT_EQ(ao.values, (std::vector<int>{0, 13107, 26214, 39321, 52428, 65535}));
}

TEST(MapFiles, AnExrHasALayerPerAttribute) {
    const ScratchFolder folder;
    for (const MapDepth depth : {MapDepth::automatic, MapDepth::single}) {
        const auto files = write_maps(small_maps(), folder / "map.exr", {.depth = depth});
        ASSERT_EQ(files.size(), 1u);
        const ImageSummary summary = summarize_image(files[0]);
        EXPECT_EQ(summary.width, 3);
        for (const char* name : {"R", "G", "B", "A", "AO.R", "BentNormal.X", "BentNormal.Z", "Thickness.G"}) {
            const auto found = std::find_if(summary.channels.begin(), summary.channels.end(),
                                            [&](const ImageSummary::Channel& c) { return c.name == name; });
            ASSERT_NE(found, summary.channels.end()) << name;
            EXPECT_EQ(found->type, depth == MapDepth::single ? "float" : "half");
        }
    }
}

TEST(MapFiles, TilesHaveTheirNumberInTheName) {
    const ScratchFolder folder;
    BakedMaps maps = small_maps();
    maps.tiles.push_back(maps.tiles[0]);
    maps.tiles[1].udim = 1012;
    const auto files = write_maps(maps, folder / "map.<UDIM>.png");
    ASSERT_EQ(files.size(), 6u);
    EXPECT_EQ(files[0].filename(), "map.1001.png");
    EXPECT_EQ(files[1].filename(), "map_bent_normal.1001.png");
    EXPECT_EQ(files[3].filename(), "map.1012.png");
}

TEST(MapFiles, AttributesArePackedIntoTheChannelsOfOnePng) {
    const ScratchFolder folder;
    const auto files = write_maps(small_maps(), folder / "map.png",
                                  {.pack = {{MapAttribute::ao}, {{}, 0.0f}, {MapAttribute::thickness}, {{}, 1.0f}}});
    ASSERT_EQ(files.size(), 1u);
    const Png png = read_png(files[0]);
    EXPECT_EQ(png.color_type, PNG_COLOR_TYPE_RGB_ALPHA);
    EXPECT_EQ(std::vector<int>(png.values.begin() + 4, png.values.begin() + 8), (std::vector<int>{51, 0, 64, 255}));
    EXPECT_THROW(write_maps(small_maps(), folder / "a.png", {.pack = {{MapAttribute::convexity}}}), InputError);
    EXPECT_THROW(write_maps(small_maps(), folder / "a.png", {.pack = {{MapAttribute::bent_normal}}}), InputError);
    EXPECT_THROW(write_maps(small_maps(), folder / "a.exr", {.pack = {{MapAttribute::ao}}}), InputError);
}

TEST(MapFiles, DepthsOfTheOtherFormatAndOtherExtensionsAreRefused) {
    const ScratchFolder folder;
    EXPECT_THROW(write_maps(small_maps(), folder / "map.png", {.depth = MapDepth::half}), InputError);
    EXPECT_THROW(write_maps(small_maps(), folder / "map.exr", {.depth = MapDepth::eight}), InputError);
    EXPECT_THROW(write_maps(small_maps(), folder / "map.jpg"), InputError);
    EXPECT_TRUE(std::filesystem::is_empty(folder / ""));
}

}
}
