/// glTF scenes and points as input and output of the program.
#include "gltf_builder.h"
#include "program.h"

#include "alcove/mesh/files.h"
#include "alcove/render/detail/png_file.h"

#include <cmath>

namespace alcove::test {
namespace {

class BakeGltf : public ProgramTest {
  protected:
    /// A floor with a lid above it, in nodes named "floor" and "lid".
    void write_room() const {
        GltfBuilder room;
        const std::size_t square = room.add_mesh({room.square()});
        const std::size_t floor = room.add_node({{"name", "floor"}, {"mesh", square}});
        const std::size_t lid = room.add_node(
            {{"name", "lid"}, {"mesh", square}, {"rotation", {1, 0, 0, 0}}, {"translation", {0, 1, 0.5}}});
        room.show({floor, lid});
        write("room.glb", room.glb());
    }
    GltfBuilder::Json json_of(const std::string& name) const {
        const std::string bytes = bytes_of(name);
        std::uint32_t length = 0;
        std::memcpy(&length, bytes.data() + 12, sizeof(length));
        return GltfBuilder::Json::parse(bytes.substr(20, length));
    }
};

TEST_F(BakeGltf, AddsValuesToTheScene) {
    write_room();
    const Outcome outcome = run({"bake", "room.glb", "-o", "out.glb", "--attributes", "ao,bent_normal", "--json"});
    ASSERT_EQ(outcome.code, done) << outcome.err;
    EXPECT_EQ(outcome.json().at("vertices"), 8);
    const auto json = json_of("out.glb");
    const auto& attributes = json["meshes"][0]["primitives"][0]["attributes"];
    for (const char* name : {"_AO", "_BENT_NORMAL", "COLOR_0", "POSITION"})
        EXPECT_TRUE(attributes.contains(name)) << name;
    EXPECT_NE(json["asset"]["extras"]["comments"][0].get<std::string>().find("alcove "), std::string::npos);
    EXPECT_EQ(run({"info", "out.glb"}).code, done);
}

TEST_F(BakeGltf, ChoosesParts) {
    write_room();
    ASSERT_EQ(run({"bake", "room.glb", "-o", "out.glb", "--only", "fl*", "--radius", "inf"}).code, done);
    EXPECT_EQ(json_of("out.glb")["meshes"].size(), 2u); // the lid keeps the mesh without values
    ASSERT_EQ(run({"bake", "room.glb", "-o", "out.ply", "--exclude", "lid", "--radius", "inf"}).code, done);
    EXPECT_EQ(read_mesh(folder_ / "work/out.ply").vertex_count(), 8u);
    expect_refusal({"bake", "room.glb", "-o", "out.glb", "--no-occlude", "lit"}, bad_input, {"'lit'", "'lid'"});
    expect_refusal({"bake", "room.glb", "-o", "out.glb", "--self", "--no-occlude", "lid"}, usage, {"--self"});
}

TEST_F(BakeGltf, WritesOcclusionTextures) {
    GltfBuilder builder;
    auto square = builder.square();
    square["attributes"]["TEXCOORD_0"] = builder.add(std::vector<float>{0, 0, 0, 0, 0, 0, 0, 0}, 2);
    square["attributes"]["TEXCOORD_1"] =
        builder.add(std::vector<float>{0.1f, 0.1f, 0.9f, 0.1f, 0.9f, 0.9f, 0.1f, 0.9f}, 2);
    builder.show({builder.add_node({{"mesh", builder.add_mesh({square}, "sheet")}})});
    write("sheet.glb", builder.glb());
    const Outcome outcome = run({"bake", "sheet.glb", "-o", "out.glb", "--into", "texture", "--size", "64"});
    ASSERT_EQ(outcome.code, done) << outcome.err;
    const auto json = json_of("out.glb");
    EXPECT_EQ(json["materials"][0]["occlusionTexture"]["texCoord"], 1);
    EXPECT_EQ(json["meshes"][0]["primitives"][0]["material"], 0);
    EXPECT_EQ(json["images"][0]["mimeType"], "image/png");
    EXPECT_EQ(run({"bake", "sheet.glb", "-o", "map.png", "--size", "64", "--uv-set", "1"}).code, done);
    expect_refusal({"bake", "sheet.glb", "-o", "map.png", "--uv-set", "2"}, bad_input, {"--uv-set 2", "2 sets of UVs"});
    expect_refusal({"bake", "sheet.glb", "-o", "out.ply", "--into", "texture"}, usage, {"--into texture", ".glb"});
    expect_refusal({"bake", "sheet.glb", "-o", "out.glb", "--size", "64"}, usage, {"--size", "--into texture"});
    expect_refusal({"bake", "sheet.glb", "-o", "out.glb", "--into", "texture", "--size", "20000"}, usage,
                   {"--size takes 1 to 16384 texels"});
    write_room();
    expect_refusal({"bake", "room.glb", "-o", "out.glb", "--into", "texture"}, bad_input,
                   {"no set of UVs without overlaps", "--into vertices"});
}

TEST_F(BakeGltf, PacksOcclusionIntoMetallicRoughnessTextures) {
    GltfBuilder builder;
    const std::string png = encode_png_file(16, 8, 3, 8, std::vector<std::uint16_t>(384, 7));
    builder.json["images"] = {
        {{"name", "metal"}, {"bufferView", builder.add_view(std::vector(png.begin(), png.end()))}}};
    builder.json["textures"] = {{{"source", 0}}};
    builder.json["materials"] = {{{"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", 0}}}}}}};
    auto square = builder.square();
    square["attributes"]["TEXCOORD_0"] = builder.add(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, 2);
    square["material"] = 0;
    builder.show({builder.add_node({{"mesh", builder.add_mesh({square}, "sheet")}})});
    write("sheet.glb", builder.glb());
    const Outcome outcome = run({"bake", "sheet.glb", "-o", "out.glb", "--into", "texture", "--pack-orm", "--json"});
    ASSERT_EQ(outcome.code, done) << outcome.err;
    EXPECT_EQ(outcome.json().at("size"), (nlohmann::json{16, 8}));
    const auto json = json_of("out.glb");
    EXPECT_EQ(json["materials"][0]["occlusionTexture"]["index"], 0);
    EXPECT_EQ(json["images"].size(), 1u);
    EXPECT_EQ(json["images"][0]["name"], "metal");
    expect_refusal({"bake", "sheet.glb", "-o", "out.glb", "--pack-orm"}, usage, {"--pack-orm", "--into texture"});
    expect_refusal({"bake", "sheet.glb", "-o", "map.png", "--pack-orm"}, usage, {"--pack-orm", "--into texture"});
    builder.json["images"][0]["bufferView"] = 1; // positions
    write("sheet.glb", builder.glb());
    expect_refusal({"bake", "sheet.glb", "-o", "out.glb", "--into", "texture", "--pack-orm"}, bad_input,
                   {"sheet.glb: images[0]", "neither a PNG nor a JPEG"});
    EXPECT_EQ(run({"bake", "sheet.glb", "-o", "out.glb", "--into", "texture", "--size", "16"}).code, done);
}

TEST_F(BakeGltf, PointsKeepTheirOrderAndProperties) {
    std::string rows =
        "ply\nformat ascii 1.0\ncomment a scan\nelement vertex 2601\nproperty float x\nproperty float y\n"
        "property float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty int id\n"
        "end_header\n";
    for (int i = 0; i < 2601; ++i)
        rows += std::to_string(i % 51) + " " + std::to_string(i / 51) + " 0 0 0 1 " + std::to_string(7 * i) + "\n";
    write("points.ply", rows);
    const Outcome outcome = run({"bake", "points.ply", "-o", "out.ply", "--json"});
    ASSERT_EQ(outcome.code, done) << outcome.err;
    const Mesh points = read_mesh(folder_ / "work/out.ply");
    EXPECT_EQ(points.vertex_count(), 2601u);
    EXPECT_EQ(points.face_count(), 0u);
    EXPECT_EQ(points.positions[53], Vec3d(2, 1, 0));
    const std::string bytes = bytes_of("out.ply");
    for (const char* line : {"comment a scan", "property int id", "property float ao"})
        EXPECT_NE(bytes.find(line), std::string::npos) << line;
    EXPECT_EQ(run({"voxelize", "points.ply", "-o", "points.vdb"}).code, done);
    EXPECT_EQ(run({"render", "points.ply", "-o", "points.png", "--size", "32x32"}).code, done);
    EXPECT_EQ(run({"info", "points.ply"}).code, done);
    write("cube.off", cube_off);
    EXPECT_EQ(run({"bake", "cube.off", "-o", "cube.ply", "--occluder", "points.ply"}).code, done);
    expect_refusal({"measure", "points.ply", "--json", "out.json"}, bad_input, {"points.ply", "no faces"});
    for (const char* option : {"--weld", "--tessellate"})
        expect_refusal({"bake", "points.ply", "-o", "out.ply", option, "0.1"}, usage,
                       {option, "points.ply contains points"});
    expect_refusal({"voxelize", "points.ply", "-o", "out.vdb", "--weld", "0.1"}, usage, {"--weld", "contains points"});
    expect_refusal({"render", "points.ply", "-o", "out.png", "--weld", "0.1"}, bad_input, {"weld", "contains points"});
    expect_refusal({"info", "points.ply", "--weld", "0.1"}, usage, {"--weld", "contains points"});
}

}
}
