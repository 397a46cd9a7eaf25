#include "gltf_builder.h"
#include "scratch_files.h"

#include "alcove/base/types.h"
#include "alcove/mesh/detail/source.h"
#include "alcove/mesh/formats/gltf/gltf_write.h"

#include <cmath>

using namespace alcove;
using Json = GltfBuilder::Json;

namespace {

/// A written .glb or .gltf, taken apart without the library.
struct Written {
    Json json;
    std::string binary, rest;

    explicit Written(const std::string& bytes) {
        if (!bytes.starts_with("glTF")) {
            json = Json::parse(bytes);
            return;
        }
        EXPECT_EQ(number(bytes, 8), bytes.size());
        std::size_t at = 12;
        for (int chunk = 0; at + 8 <= bytes.size(); ++chunk) {
            const std::string data = bytes.substr(at + 8, number(bytes, at));
            EXPECT_EQ(data.size() % 4, 0u);
            if (chunk == 0)
                json = Json::parse(data);
            else if (chunk == 1)
                binary = data;
            else
                rest = bytes.substr(at, 8) + data;
            at += 8 + data.size();
        }
        EXPECT_EQ(at, bytes.size());
    }

    std::vector<float> floats(std::size_t accessor) const {
        const Json& a = json["accessors"][accessor];
        EXPECT_EQ(a["componentType"], 5126);
        const Json& view = json["bufferViews"][a["bufferView"].get<std::size_t>()];
        EXPECT_EQ(view["buffer"], 0);
        const std::string data = binary.substr(view["byteOffset"], view["byteLength"]);
        std::vector<float> values(data.size() / sizeof(float));
        std::memcpy(values.data(), data.data(), data.size());
        return values;
    }
    std::vector<float> values(std::size_t mesh, const char* attribute) const {
        return floats(json["meshes"][mesh]["primitives"][0]["attributes"][attribute]);
    }

    static std::size_t number(const std::string& bytes, std::size_t at) {
        std::uint32_t word = 0;
        std::memcpy(&word, bytes.data() + at, sizeof(word));
        return word;
    }
};

/// Whether everything in `before` is in `after`, apart from the paths given.
void expect_kept(const Json& before, const Json& after, const std::vector<std::string>& changed,
                 const std::string& path = "") {
    if (std::find(changed.begin(), changed.end(), path) != changed.end())
        return;
    ASSERT_EQ(before.type(), after.type()) << path;
    if (before.is_object()) {
        for (const auto& [key, value] : before.items()) {
            ASSERT_TRUE(after.contains(key)) << path << "/" << key;
            expect_kept(value, after[key], changed, path + "/" + key);
        }
        std::vector<std::string> old_keys, kept; // in the old order
        for (const auto& [key, value] : before.items())
            old_keys.push_back(key);
        for (const auto& [key, value] : after.items())
            if (before.contains(key))
                kept.push_back(key);
        EXPECT_EQ(kept, old_keys) << path;
    } else if (before.is_array()) {
        ASSERT_LE(before.size(), after.size()) << path;
        for (std::size_t i = 0; i < before.size(); ++i)
            expect_kept(before[i], after[i], changed, path + "/" + std::to_string(i));
    } else {
        EXPECT_EQ(before, after) << path;
    }
}

class GltfWrite : public ScratchFiles {
  protected:
    /// Two nodes show one square.
    static GltfBuilder two_squares() {
        GltfBuilder builder;
        const std::size_t mesh = builder.add_mesh({builder.square()}, "square");
        builder.show({builder.add_node({{"name", "left"}, {"mesh", mesh}}),
                      builder.add_node({{"name", "right"}, {"mesh", mesh}, {"translation", {5, 0, 0}}})});
        return builder;
    }
    Written written(const std::string& name) { return Written(bytes_of(name)); }
};

std::vector<float> ramp(std::size_t count, float from) {
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i)
        values[i] = from + 0.01f * static_cast<float>(i);
    return values;
}

}

TEST_F(GltfWrite, KeepsEverythingAndAddsValues) {
    GltfBuilder builder;
    builder.show({builder.add_node({{"mesh", builder.add_mesh({builder.square()})}, {"extras", {{"weight", 1.5}}}})});
    builder.json["extensionsUsed"] = {"ACME_paint"};
    builder.json["extensions"] = {{"ACME_paint", {{"layers", {1, 2.50, "\u00e9"}}}}};
    builder.json["asset"]["generator"] = "by hand";
    builder.json["animations"] = Json::array();
    builder.json["zebra"] = 1;
    builder.json["alpha"] = -0.0;
    Mesh mesh = read("in.glb", builder.glb() + std::string());
    mesh.set_attribute({"ao", 1, ramp(4, 0.1f)});
    mesh.set_attribute({"bent_normal", 3, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 1, 0}});
    mesh.added_colors = grey_colors(ramp(4, 0.1f));
    mesh.added_comments = {"alcove 0: ao by exact"};
    EXPECT_TRUE(write_mesh(mesh, path("out.glb")).empty());
    const Written out = written("out.glb");
    expect_kept(Json::parse(builder.json.dump()), out.json, {"/buffers/0/byteLength"});
    EXPECT_EQ(out.binary.substr(0, builder.bytes.size()), builder.bytes);
    EXPECT_EQ(out.values(0, "_AO"), ramp(4, 0.1f));
    EXPECT_EQ(out.values(0, "_BENT_NORMAL"), (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 1, 0}));
    EXPECT_EQ(out.json["asset"]["extras"]["comments"][0], "alcove 0: ao by exact");
    const Mesh again = read_mesh(path("out.glb"));
    ASSERT_EQ(again.vertex_colors.size(), 4u);
    for (std::size_t v = 0; v < 4; ++v) // linear 16 bits and back
        EXPECT_EQ(again.vertex_colors[v], mesh.added_colors[v]);
    EXPECT_EQ(again.source->comment("alcove "), "alcove 0: ao by exact");
}

TEST_F(GltfWrite, WithoutValuesAFileStaysAsItIs) {
    GltfBuilder builder = two_squares();
    const std::string bytes = builder.glb();
    write_mesh(read("in.glb", bytes), path("out.glb"));
    EXPECT_EQ(bytes_of("out.glb"), bytes);
}

TEST_F(GltfWrite, ASecondBakeReplacesTheValuesOfTheFirst) {
    GltfBuilder builder = two_squares();
    Mesh mesh = read("in.glb", builder.glb());
    mesh.set_attribute({"ao", 1, ramp(8, 0.2f)});
    mesh.added_colors = grey_colors(ramp(8, 0.2f));
    mesh.added_comments = {"alcove 0: ao"};
    write_mesh(mesh, path("first.glb"));
    Mesh again = read_mesh(path("first.glb"));
    again.set_attribute({"ao", 1, ramp(8, 0.4f)});
    again.added_colors = grey_colors(ramp(8, 0.4f));
    again.added_comments = {"alcove 0: ao"};
    write_mesh(again, path("second.glb"));
    EXPECT_EQ(bytes_of("second.glb").size(), bytes_of("first.glb").size());
    const Written out = written("second.glb");
    const std::vector<float> wanted = ramp(8, 0.4f);
    EXPECT_EQ(out.values(0, "_AO"), std::vector<float>(wanted.begin(), wanted.begin() + 4));
    EXPECT_EQ(out.values(1, "_AO"), std::vector<float>(wanted.begin() + 4, wanted.end()));
}

TEST_F(GltfWrite, KeepsOtherChunks) {
    GltfBuilder builder = two_squares();
    std::string bytes = builder.glb();
    const std::string chunk = packed(std::uint32_t(4), std::uint32_t(0x4d4f4f46)) + "abcd";
    bytes += chunk;
    const auto length = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(bytes.data() + 8, &length, 4);
    Mesh mesh = read("in.glb", bytes);
    mesh.set_attribute({"ao", 1, ramp(8, 0.0f)});
    mesh.instance_error = 1.0;
    write_mesh(mesh, path("out.glb"));
    EXPECT_EQ(written("out.glb").rest, chunk);
}

TEST_F(GltfWrite, InstancesShareValuesThatAreClose) {
    GltfBuilder builder = two_squares();
    Mesh mesh = read("in.glb", builder.glb());
    mesh.set_attribute({"ao", 1, {0.5f, 0.5f, 0.5f, 0.5f, 0.51f, 0.51f, 0.51f, 0.51f}});
    mesh.instance_error = 0.02;
    const auto messages = write_mesh(mesh, path("out.glb"));
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_EQ(
        messages[0],
        "1 instance shares the values of another instance of the same mesh; they differ by an RMSE of at most 0.01");
    const Written out = written("out.glb");
    EXPECT_EQ(out.json["meshes"].size(), 1u);
    EXPECT_EQ(out.values(0, "_AO"), std::vector<float>(4, 0.5f));
}

TEST_F(GltfWrite, InstancesThatDifferGetACopyOfTheMesh) {
    GltfBuilder builder = two_squares();
    builder.json["meshes"][0]["extras"] = {{"kept", true}};
    Mesh mesh = read("in.glb", builder.glb());
    mesh.set_attribute({"ao", 1, {0.5f, 0.5f, 0.5f, 0.5f, 1, 1, 1, 1}});
    mesh.instance_error = 0.02;
    const auto messages = write_mesh(mesh, path("out.glb"));
    ASSERT_EQ(messages.size(), 1u);
    const Written out = written("out.glb");
    expect_kept(Json::parse(builder.json.dump()), out.json, {"/buffers/0/byteLength", "/nodes/1/mesh"});
    ASSERT_EQ(out.json["meshes"].size(), 2u);
    EXPECT_EQ(out.json["nodes"][1]["mesh"], 1);
    EXPECT_EQ(out.json["meshes"][1]["extras"]["kept"], true);
    EXPECT_EQ(out.values(0, "_AO"), std::vector<float>(4, 0.5f));
    EXPECT_EQ(out.values(1, "_AO"), std::vector<float>(4, 1.0f));
}

TEST_F(GltfWrite, NodesThatWereNotBakedStayAsTheyAre) {
    GltfBuilder builder = two_squares();
    Mesh mesh = read("in.glb", builder.glb());
    mesh.set_attribute({"ao", 1, std::vector<float>(8, 0.5f)});
    mesh.baked_vertices = {0, 0, 0, 0, 1, 1, 1, 1};
    write_mesh(mesh, path("out.glb"));
    const Written out = written("out.glb");
    EXPECT_EQ(out.json["nodes"][0]["mesh"], 0);
    EXPECT_EQ(out.json["nodes"][1]["mesh"], 1);
    EXPECT_FALSE(out.json["meshes"][0]["primitives"][0]["attributes"].contains("_AO"));
    EXPECT_TRUE(out.json["meshes"][1]["primitives"][0]["attributes"].contains("_AO"));
}

TEST_F(GltfWrite, BentNormalsAreInTheSpaceOfTheNode) {
    GltfBuilder builder;
    const double half = std::sqrt(0.5); // turned by 90 degrees around z: x becomes y
    builder.show(
        {builder.add_node({{"mesh", builder.add_mesh({builder.square()})}, {"rotation", {0, 0, half, half}}})});
    Mesh mesh = read("in.glb", builder.glb());
    mesh.set_attribute({"bent_normal", 3, {0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0}});
    write_mesh(mesh, path("out.glb"));
    const std::vector<float> local = written("out.glb").values(0, "_BENT_NORMAL");
    EXPECT_NEAR(local[0], 1.0f, 1e-6f);
    EXPECT_NEAR(local[1], 0.0f, 1e-6f);
}

TEST_F(GltfWrite, EmbedsBuffersAndMovesPathsOfImages) {
    GltfBuilder builder = two_squares();
    std::filesystem::create_directories(path("in"));
    write("in/mesh.bin", builder.bytes);
    write("in/paint 1.png", "not decoded");
    builder.json["images"] = {{{"uri", "paint%201.png"}}, {{"uri", "missing.png"}}};
    Mesh mesh = read("in/scene.gltf", builder.gltf("mesh.bin"));
    mesh.set_attribute({"ao", 1, ramp(8, 0.2f)});
    mesh.instance_error = 1.0;
    const auto messages = write_mesh(mesh, path("out.gltf"));
    ASSERT_EQ(messages.size(), 3u);
    const Json json = written("out.gltf").json;
    EXPECT_EQ(json["images"][0]["uri"], "in/paint%201.png");
    EXPECT_EQ(json["images"][1]["uri"], "missing.png");
    EXPECT_TRUE(json["buffers"][0]["uri"].get<std::string>().starts_with("data:"));
    EXPECT_EQ(read_mesh(path("out.gltf")).positions, mesh.positions);
    // Beside the input, the buffer stays a file.
    write_mesh(mesh, path("in/out.gltf"));
    EXPECT_EQ(written("in/out.gltf").json["buffers"][0]["uri"], "mesh.bin");
    EXPECT_EQ(read_mesh(path("in/out.gltf")).positions, mesh.positions);
}

TEST_F(GltfWrite, GlbAndGltfBecomeEachOther) {
    GltfBuilder builder = two_squares();
    Mesh mesh = read("in.glb", builder.glb());
    mesh.set_attribute({"ao", 1, ramp(8, 0.2f)});
    mesh.instance_error = 1.0;
    write_mesh(mesh, path("out.gltf"));
    Mesh second = read_mesh(path("out.gltf"));
    EXPECT_EQ(second.positions, mesh.positions);
    second.set_attribute({"convexity", 1, ramp(8, 0.3f)});
    second.instance_error = 1.0;
    write_mesh(second, path("again.glb"));
    EXPECT_EQ(read_mesh(path("again.glb")).positions, mesh.positions);
    const Json json = written("again.glb").json;
    EXPECT_TRUE(json["meshes"][0]["primitives"][0]["attributes"].contains("_AO"));
    EXPECT_TRUE(json["meshes"][0]["primitives"][0]["attributes"].contains("_CONVEXITY"));
}

TEST_F(GltfWrite, OtherFormatsBecomeOneNodeWithMaterials) {
    write("paint.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
    Mesh mesh = read(
        "in.obj", "mtllib paint.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 0.5\n"
                  "usemtl red\nf 1/1 2/2 3/3 4/4\nusemtl blue\nf 1/5 3/3 4/4\n");
    mesh.set_attribute({"ao", 1, ramp(4, 0.2f)});
    const auto messages = write_mesh(mesh, path("out.glb"));
    const Written out = written("out.glb");
    const Json& primitives = out.json["meshes"][0]["primitives"];
    ASSERT_EQ(primitives.size(), 2u);
    std::vector<std::string> names;
    for (const Json& primitive : primitives) {
        const Json& material = out.json["materials"][primitive["material"].get<std::size_t>()];
        names.push_back(material["name"]);
        EXPECT_EQ(material["pbrMetallicRoughness"]["baseColorFactor"],
                  names.back() == "red" ? Json({1.0, 0.0, 0.0, 1.0}) : Json({0.0, 0.0, 1.0, 1.0}));
    }
    std::sort(names.begin(), names.end());
    EXPECT_EQ(names, (std::vector<std::string>{"blue", "red"}));
    const Mesh again = read_mesh(path("out.glb"));
    EXPECT_EQ(again.vertex_count(), 5u); // the first vertex has two texture coordinates
    EXPECT_EQ(again.face_count(), 3u);
    const std::vector<float> ao = out.values(0, "_AO");
    for (std::size_t v = 0; v < 5; ++v)
        for (std::size_t old = 0; old < 4; ++old)
            if (again.positions[v] == mesh.positions[old]) {
                EXPECT_EQ(ao[v], mesh.attributes[0].values[old]);
            }
}

TEST_F(GltfWrite, TheOnlyObjectOfAnObjNamesTheNode) {
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\n", face = "f 1 2 3\n";
    const auto name = [&](const std::string& lines) {
        write_mesh(read("in.obj", vertices + lines), path("out.glb"));
        const Json json = written("out.glb").json;
        EXPECT_EQ(json["nodes"][0].value("name", ""), json["meshes"][0].value("name", ""));
        return json["nodes"][0].value("name", "");
    };
    EXPECT_EQ(name("o chair\n" + face), "chair");
    EXPECT_EQ(name("o chair\nusemtl red\n" + face + "g legs\nusemtl blue\n" + face), "chair");
    EXPECT_EQ(name("g legs\n" + face), "legs");
    EXPECT_EQ(name("o chair\n" + face + "o table\n" + face), "");
    EXPECT_EQ(name("usemtl red\n" + face), "");
    EXPECT_EQ(name(face), "");
}

TEST_F(GltfWrite, FarCoordinatesMoveIntoTheNode) {
    Mesh mesh = read("in.obj", "v 100000000 0 0\nv 100000001 0 0\nv 100000001 1 0\nf 1 2 3\n");
    write_mesh(mesh, path("out.glb"));
    EXPECT_EQ(read_mesh(path("out.glb")).positions, mesh.positions);
}

TEST_F(GltfWrite, ScenesBecomeMeshesOfOtherFormats) {
    GltfBuilder builder = two_squares();
    Mesh mesh = read("in.glb", builder.glb());
    mesh.set_attribute({"ao", 1, ramp(8, 0.2f)});
    const auto lost = write_mesh(mesh, path("out.ply"));
    EXPECT_EQ(lost, (std::vector<std::string>{"not stored in PLY: 2 nodes", "not stored in PLY: 1 scene"}));
    EXPECT_EQ(read_mesh(path("out.ply")).positions, mesh.positions);
}

TEST_F(GltfWrite, TexturesBelongToMaterials) {
    GltfBuilder builder = two_squares();
    builder.json["materials"] = Json::array({{{"name", "paint"}}});
    builder.json["meshes"][0]["primitives"][0]["material"] = 0;
    Json bare = builder.square();
    builder.json["scenes"][0]["nodes"].push_back(builder.add_node({{"mesh", builder.add_mesh({bare})}}));
    const Mesh mesh = read("in.glb", builder.glb());
    const std::vector<std::pair<std::size_t, std::size_t>> of_squares{{0, 0}}, of_bare{{1, 0}};
    const std::vector<GltfTexture> textures{GltfTexture{0, of_squares, 0, "first image"},
                                            GltfTexture{std::nullopt, of_bare, 1, "second"}};
    write_gltf(mesh, path("out.glb"), textures);
    const Written out = written("out.glb");
    ASSERT_EQ(out.json["materials"].size(), 2u);
    EXPECT_EQ(out.json["materials"][0]["name"], "paint");
    EXPECT_EQ(out.json["meshes"][1]["primitives"][0]["material"], 1);
    EXPECT_EQ(out.json["materials"][1]["occlusionTexture"]["texCoord"], 1);
    const auto image = [&](std::size_t material) {
        const std::size_t texture = out.json["materials"][material]["occlusionTexture"]["index"];
        const std::size_t source = out.json["textures"][texture]["source"];
        const Json& view = out.json["bufferViews"][out.json["images"][source]["bufferView"].get<std::size_t>()];
        return out.binary.substr(view["byteOffset"], view["byteLength"]);
    };
    EXPECT_EQ(image(0), "first image");
    EXPECT_EQ(image(1), "second");
}
