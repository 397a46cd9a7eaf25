/// bake_occlusion_textures() and write_occlusion_textures() with metallic-roughness textures.
#include "alcove/base/detail/limits.h"
#include "alcove/maps/maps.h"
#include "alcove/mesh/files.h"
#include "alcove/render/detail/png_file.h"

#include "gltf_builder.h"
#include "png_values.h"
#include "scratch_files.h"

#include <cstdio> // before jpeglib.h, which needs it
#include <jpeglib.h>

#include <algorithm>
#include <array>

namespace alcove {
namespace {

using Json = GltfBuilder::Json;

std::string grey_jpeg(int width, int height, int grey) {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &bytes, &size);
    jpeg.image_width = static_cast<JDIMENSION>(width);
    jpeg.image_height = static_cast<JDIMENSION>(height);
    jpeg.input_components = 1;
    jpeg.in_color_space = JCS_GRAYSCALE;
    jpeg_set_defaults(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    std::vector<JSAMPLE> values(static_cast<std::size_t>(width), static_cast<JSAMPLE>(grey));
    JSAMPROW row = values.data();
    for (int y = 0; y < height; ++y)
        jpeg_write_scanlines(&jpeg, &row, 1);
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    std::string result(reinterpret_cast<const char*>(bytes), size);
    std::free(bytes);
    return result;
}

/// A PNG of 2 × 2 texels: red is 9, green and blue differ between texels.
std::string orm_png() {
    return encode_png_file(2, 2, 3, 8, std::vector<std::uint16_t>{9, 10, 20, 9, 11, 21, 9, 12, 22, 9, 13, 23});
}

class PackedTextures : public ScratchFiles {
  protected:
    /// Adds an image, and a texture of it with a sampler.
    static std::size_t add_texture(GltfBuilder& builder, const std::string& bytes) {
        const std::size_t view = builder.add_view(std::vector<char>(bytes.begin(), bytes.end()));
        builder.json["samplers"] = {{{"wrapS", 33071}}};
        builder.json["images"].push_back({{"name", "metal"}, {"bufferView", view}, {"mimeType", "image/png"}});
        builder.json["textures"].push_back({{"source", builder.json["images"].size() - 1}, {"sampler", 0}});
        return builder.json["textures"].size() - 1;
    }
    /// Adds a square with that material beside the others; its UVs fill the texture.
    static void add_square(GltfBuilder& builder, const Json& material) {
        Json square = builder.square();
        const std::vector<float> uvs{0, 0, 1, 0, 1, 1, 0, 1};
        square["attributes"]["TEXCOORD_0"] = builder.add(uvs, 2);
        square["attributes"]["TEXCOORD_1"] = builder.add(uvs, 2);
        builder.json["materials"].push_back(material);
        square["material"] = builder.json["materials"].size() - 1;
        const std::size_t mesh = builder.add_mesh({square});
        const std::size_t node = builder.add_node({{"mesh", mesh}, {"translation", {2.0 * double(mesh), 0, 0}}});
        builder.json["scenes"][0]["nodes"].push_back(node);
    }
    static Json metal(std::size_t texture, const std::string& name = "paint") {
        return {{"name", name}, {"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", texture}}}}}};
    }
    /// A square with one texture, the image of which comes first in the file.
    GltfBuilder one_square(const std::string& image = orm_png()) const {
        GltfBuilder builder;
        const std::size_t texture = add_texture(builder, image);
        add_square(builder, metal(texture));
        return builder;
    }

    Mesh read_scene(GltfBuilder& builder) const { return read("in.glb", builder.glb()); }
    /// Textures of 2 × 2 texels with ao 0, 0.2, 0.4 and 1, one for each material.
    static OcclusionTextures textures_of(std::size_t materials, bool packed = true, int width = 2, int height = 2) {
        OcclusionTextures textures;
        textures.maps.width = textures.maps.height = 2;
        textures.maps.baked.method = "traced";
        textures.maps.baked.radius = 0.5;
        for (std::size_t m = 0; m < materials; ++m) {
            textures.textures.push_back({m, {{m, 0}}, 0, width, height, packed});
            textures.maps.tiles.push_back({1001, {{MapAttribute::ao, {0.0f, 0.2f, 0.4f, 1.0f}}}, {}});
        }
        return textures;
    }

    struct Written {
        Json json;
        std::string binary;
    };
    Written written(const std::string& name) const {
        const std::string bytes = bytes_of(name);
        std::uint32_t length = 0;
        std::memcpy(&length, bytes.data() + 12, sizeof(length));
        return {Json::parse(bytes.substr(20, length)), bytes.substr(28 + length)};
    }
    /// The occlusion image of a material in a .glb.
    Png occlusion(const std::string& name, std::size_t material) const {
        const Written file = written(name);
        const std::size_t texture = file.json["materials"][material]["occlusionTexture"]["index"];
        const Json& image = file.json["images"][file.json["textures"][texture]["source"].get<std::size_t>()];
        EXPECT_EQ(image["mimeType"], "image/png");
        const Json& view = file.json["bufferViews"][image["bufferView"].get<std::size_t>()];
        return read_png(write("image.png", file.binary.substr(view["byteOffset"], view["byteLength"])));
    }
    std::string refusal(const std::string& image, TexturePacking packing = TexturePacking::size_of_image) const {
        GltfBuilder builder = one_square(image);
        const Mesh mesh = read_scene(builder);
        try {
            bake_occlusion_textures(mesh, {}, {.width = 8, .height = 8}, packing);
            write_occlusion_textures(mesh, textures_of(1), path("out.glb"));
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    }
};

TEST_F(PackedTextures, RedIsOcclusionAndTheOtherChannelsStay) {
    GltfBuilder builder = one_square();
    const Mesh mesh = read_scene(builder);
    EXPECT_TRUE(write_occlusion_textures(mesh, textures_of(1), path("out.glb")).empty());
    const Png png = occlusion("out.glb", 0);
    EXPECT_EQ(png.color_type, PNG_COLOR_TYPE_RGB);
    EXPECT_EQ(png.values, (std::vector<int>{0, 10, 20, 51, 11, 21, 102, 12, 22, 255, 13, 23}));
    EXPECT_FALSE(png.has_srgb || png.has_gamma);
    EXPECT_EQ(png.texts.at("Comment"), "ambient occlusion by traced, radius 0.5");
    const Written out = written("out.glb");
    EXPECT_EQ(out.json["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"], 0);
    EXPECT_EQ(out.json["materials"][0]["occlusionTexture"]["index"], 0);
    EXPECT_EQ(out.json["textures"], builder.json["textures"]);
    ASSERT_EQ(out.json["images"].size(), 1u);
    EXPECT_EQ(out.json["images"][0]["name"], "metal");
    EXPECT_TRUE(out.json["images"][0]["extras"]["comments"][0].get<std::string>().starts_with("alcove "));
    EXPECT_EQ(out.binary.find(orm_png()), std::string::npos); // the old image is gone
    EXPECT_EQ(read_mesh(path("out.glb")).positions, mesh.positions);
    EXPECT_EQ(read_mesh(path("out.glb")).vertex_uvs, mesh.vertex_uvs);
}

TEST_F(PackedTextures, BakingAgainReplacesThePixels) {
    for (const bool packed : {true, false}) {
        GltfBuilder builder = one_square();
        OcclusionTextures textures = textures_of(1, packed);
        write_occlusion_textures(read_scene(builder), textures, path("out.glb"));
        const Written first = written("out.glb");
        textures.maps.tiles[0].layers[0].values = {1.0f, 0.4f, 0.2f, 0.0f};
        for (int i = 0; i < 3; ++i)
            EXPECT_TRUE(write_occlusion_textures(read_mesh(path("out.glb")), textures, path("out.glb")).empty());
        const Written again = written("out.glb");
        EXPECT_EQ(again.json["images"], first.json["images"]);
        EXPECT_EQ(again.json["textures"], first.json["textures"]);
        EXPECT_EQ(again.json["materials"], first.json["materials"]);
        EXPECT_NEAR(double(again.binary.size()), double(first.binary.size()), 16.0); // compression may differ
        const Png png = occlusion("out.glb", 0);
        EXPECT_EQ(png.values, packed ? (std::vector<int>{255, 10, 20, 102, 11, 21, 51, 12, 22, 0, 13, 23})
                                     : (std::vector<int>{255, 102, 51, 0}));
        EXPECT_EQ(read_mesh(path("out.glb")).positions, read_mesh(path("in.glb")).positions);
    }
}

TEST_F(PackedTextures, AGltfWithEmbeddedDataDoesNotGrowEither) {
    GltfBuilder builder = one_square();
    write("mesh.bin", builder.bytes);
    write("in.gltf", builder.gltf("mesh.bin"));
    const OcclusionTextures textures = textures_of(1, false);
    write_occlusion_textures(read_mesh(path("in.gltf")), textures, path("out.gltf"));
    const std::string first = bytes_of("out.gltf");
    write_occlusion_textures(read_mesh(path("out.gltf")), textures, path("out.gltf"));
    EXPECT_EQ(bytes_of("out.gltf"), first);
    const Json json = Json::parse(first);
    EXPECT_EQ(json["buffers"].size(), 2u);
    EXPECT_EQ(json["buffers"][0]["uri"], "mesh.bin");
}

TEST_F(PackedTextures, SharedImagesStayAndAreCopied) {
    GltfBuilder builder;
    const std::size_t texture = add_texture(builder, orm_png());
    for (const char* name : {"one", "two"})
        add_square(builder, metal(texture, name));
    builder.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", texture}};
    const Mesh mesh = read_scene(builder);
    OcclusionTextures textures = textures_of(2);
    textures.maps.tiles[1].layers[0].values = {1.0f, 0.4f, 0.2f, 0.0f};
    write_occlusion_textures(mesh, textures, path("out.glb"));
    const Written out = written("out.glb");
    EXPECT_EQ(out.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"], texture);
    ASSERT_EQ(out.json["images"].size(), 3u);
    EXPECT_EQ(out.json["images"][0], builder.json["images"][0]);
    EXPECT_EQ(out.json["textures"][0], builder.json["textures"][0]);
    const Json& view = out.json["bufferViews"][out.json["images"][0]["bufferView"].get<std::size_t>()];
    EXPECT_EQ(out.binary.substr(view["byteOffset"], view["byteLength"]), orm_png());
    for (const std::size_t m : {0u, 1u}) {
        const Json& material = out.json["materials"][m];
        EXPECT_EQ(material["occlusionTexture"]["index"],
                  material["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"]);
        EXPECT_EQ(out.json["textures"][material["occlusionTexture"]["index"].get<std::size_t>()]["sampler"], 0);
        const Png png = occlusion("out.glb", m);
        EXPECT_EQ(png.values[0], m == 0 ? 0 : 255);
        EXPECT_EQ(png.values[9], m == 0 ? 255 : 0);
        EXPECT_EQ(png.values[10], 13);
    }
}

TEST_F(PackedTextures, BothImagesAreResampledToTheSizeOfTheTexture) {
    GltfBuilder builder = one_square();
    const Mesh mesh = read_scene(builder);
    write_occlusion_textures(mesh, textures_of(1, true, 1, 1), path("out.glb"));
    // 255 × 0.4 = 102; green and blue are means, rounded.
    EXPECT_EQ(occlusion("out.glb", 0).values, (std::vector<int>{102, 12, 22}));
    write_occlusion_textures(mesh, textures_of(1, true, 4, 2), path("out.glb"));
    const Png png = occlusion("out.glb", 0);
    EXPECT_EQ(png.width, 4u);
    EXPECT_EQ(std::vector<int>(png.values.begin(), png.values.begin() + 6), (std::vector<int>{0, 10, 20, 13, 10, 20}));
}

TEST_F(PackedTextures, ReadsTheFormatsOfImages) {
    const auto packed = [&](const std::string& image) {
        GltfBuilder builder = one_square(image);
        write_occlusion_textures(read_scene(builder), textures_of(1), path("out.glb"));
        return occlusion("out.glb", 0);
    };
    const Png jpeg = packed(grey_jpeg(2, 2, 200));
    EXPECT_EQ(jpeg.values[3], 51);
    EXPECT_NEAR(jpeg.values[4], 200, 2);
    EXPECT_NEAR(jpeg.values[5], 200, 2);
    const Png grey = packed(encode_png_file(2, 2, 1, 8, std::vector<std::uint16_t>{1, 2, 3, 4}));
    EXPECT_EQ(grey.values, (std::vector<int>{0, 1, 1, 51, 2, 2, 102, 3, 3, 255, 4, 4}));
    const Png alpha = packed(encode_png_file(2, 2, 4, 8, std::vector<std::uint16_t>(16, 7)));
    EXPECT_EQ(alpha.color_type, PNG_COLOR_TYPE_RGB_ALPHA);
    EXPECT_EQ(std::vector<int>(alpha.values.begin() + 4, alpha.values.begin() + 8), (std::vector<int>{51, 7, 7, 7}));
    const Png deep = packed(encode_png_file(2, 2, 3, 16, std::vector<std::uint16_t>(12, 1000)));
    EXPECT_EQ(deep.depth, 16);
    EXPECT_EQ(std::vector<int>(deep.values.begin() + 3, deep.values.begin() + 6),
              (std::vector<int>{13107, 1000, 1000}));
}

TEST_F(PackedTextures, DamagedImagesAreRefusedByName) {
    const std::string png = orm_png(), jpeg = grey_jpeg(64, 64, 200);
    std::string flipped = png;
    flipped[png.find("IDAT") + 8] ^= 1;
    const std::string ktx = "\xabKTX 20\xbb\r\n\x1a\n";
    for (const std::string& image : {png.substr(0, png.size() - 20), flipped, png.substr(0, 20),
                                     jpeg.substr(0, jpeg.size() / 2), jpeg.substr(0, 10), std::string("hello"), ktx})
        EXPECT_NE(refusal(image).find("in.glb: images[0]: "), std::string::npos) << refusal(image);
    EXPECT_NE(refusal(ktx).find("neither a PNG nor a JPEG"), std::string::npos);
}

TEST_F(PackedTextures, LargeImagesAreRefusedBeforeTheyAreDecoded) {
    GltfBuilder builder = one_square(encode_png_file(1000, 1000, 3, 8, std::vector<std::uint16_t>(3000000, 7)));
    const Mesh mesh = read_scene(builder);
    const double old = memory_limit();
    limit_memory(1e7);
    EXPECT_THROW(bake_occlusion_textures(mesh, {}, {.width = 8, .height = 8}, TexturePacking::size_of_map), LimitError);
    EXPECT_THROW(write_occlusion_textures(mesh, textures_of(1), path("out.glb")), LimitError);
    limit_memory(old);
}

TEST_F(PackedTextures, TheImageDecidesTheSizeUnlessOneIsGiven) {
    GltfBuilder builder;
    for (const int size : {16, 8})
        add_square(builder, metal(add_texture(builder, encode_png_file(size, 4, 3, 8,
                                                                       std::vector<std::uint16_t>(
                                                                           std::size_t(12) * std::size_t(size), 7)))));
    const Mesh mesh = read_scene(builder);
    const MapOptions options{.width = 32, .height = 32};
    const OcclusionTextures kept = bake_occlusion_textures(mesh, {}, options, TexturePacking::size_of_image);
    EXPECT_EQ(kept.maps.width, 16);
    EXPECT_EQ(kept.maps.height, 4);
    write_occlusion_textures(mesh, kept, path("out.glb"));
    EXPECT_EQ(occlusion("out.glb", 0).width, 16u);
    EXPECT_EQ(occlusion("out.glb", 1).width, 8u);
    EXPECT_EQ(occlusion("out.glb", 1).values[0], 255); // nothing occludes the squares
    write_occlusion_textures(mesh, bake_occlusion_textures(mesh, {}, options, TexturePacking::size_of_map),
                             path("out.glb"));
    EXPECT_EQ(occlusion("out.glb", 1).width, 32u);
}

TEST_F(PackedTextures, MaterialsWithoutASuitableTextureGetTheirOwn) {
    GltfBuilder builder;
    const std::size_t texture = add_texture(builder, orm_png());
    Json moved = metal(texture, "moved"), second = metal(texture, "second");
    moved["pbrMetallicRoughness"]["metallicRoughnessTexture"]["extensions"]["KHR_texture_transform"] = Json::object();
    second["pbrMetallicRoughness"]["metallicRoughnessTexture"]["texCoord"] = 1;
    add_square(builder, Json{{"name", "plain"}});
    add_square(builder, moved);
    add_square(builder, second);
    const Mesh mesh = read_scene(builder);
    const OcclusionTextures textures =
        bake_occlusion_textures(mesh, {}, {.width = 8, .height = 8}, TexturePacking::size_of_map);
    ASSERT_EQ(textures.textures.size(), 3u);
    EXPECT_FALSE(textures.textures[0].is_packed);
    EXPECT_FALSE(textures.textures[1].is_packed);
    EXPECT_TRUE(textures.textures[2].is_packed);
    EXPECT_EQ(textures.textures[2].uv_set, 1);
    const auto& warnings = textures.maps.baked.warnings;
    EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
        return warning.starts_with("--pack-orm: ") && warning.find("'plain', 'moved'") != std::string::npos;
    }));
    write_occlusion_textures(mesh, textures, path("out.glb"));
    const Json json = written("out.glb").json;
    EXPECT_EQ(json["materials"][1]["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"], texture);
    EXPECT_EQ(json["materials"][2]["occlusionTexture"]["texCoord"], 1);
    EXPECT_EQ(occlusion("out.glb", 0).color_type, PNG_COLOR_TYPE_GRAY);
    EXPECT_EQ(occlusion("out.glb", 2).color_type, PNG_COLOR_TYPE_RGB);
}

}
}
