#include "gltf_builder.h"
#include "scratch_files.h"

#include "alcove/base/types.h"
#include "alcove/mesh/diagnose.h"

#include <draco/compression/encode.h>
#include <meshoptimizer.h>

#include <cmath>
#include <functional>
#include <limits>
#include <set>

using namespace alcove;
using Json = GltfBuilder::Json;

namespace {

class GltfRead : public ScratchFiles {
  protected:
    Mesh read_built(GltfBuilder& builder) { return read("scene.glb", builder.glb()); }
    /// A scene of one node with that primitive.
    Mesh read_primitive(GltfBuilder& builder, Json primitive) {
        builder.show({builder.add_node({{"mesh", builder.add_mesh({std::move(primitive)})}})});
        return read_built(builder);
    }
    std::string refusal(const std::string& bytes, const std::string& name = "scene.glb") {
        try {
            read(name, bytes);
        } catch (const InputError& error) {
            return error.what();
        } catch (const LimitError& error) {
            return error.what();
        }
        return "";
    }
    std::string refusal(GltfBuilder& builder) { return refusal(builder.glb()); }
};

void expect_has(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text << "\nlacks: " << part;
}

const std::vector<float> cube_corners{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1};
const std::vector<std::uint16_t> cube_indices{0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                              2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};

Json cube(GltfBuilder& builder) {
    return {{"attributes", {{"POSITION", builder.add(cube_corners, 3)}}}, {"indices", builder.add(cube_indices)}};
}

/// The triangles by coordinates, each from its smallest corner on, in any order.
std::multiset<std::vector<double>> triangles_of(const Mesh& mesh) {
    std::multiset<std::vector<double>> all;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        std::vector<std::vector<double>> corners;
        for (const std::uint32_t v : mesh.face(f))
            corners.push_back({mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z});
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        std::vector<double> flat;
        for (const auto& corner : corners)
            flat.insert(flat.end(), corner.begin(), corner.end());
        all.insert(flat);
    }
    return all;
}

}

TEST_F(GltfRead, ReadsValuesOfVertices) {
    GltfBuilder builder;
    Json square = builder.square();
    square["attributes"]["NORMAL"] = builder.add(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 2}, 3);
    square["attributes"]["TEXCOORD_0"] = builder.add(std::vector<float>{0, 0, 1, 0, 1, 0.75f, 0, 1}, 2);
    square["attributes"]["COLOR_0"] =
        builder.add(std::vector<float>{1, 0, 0, 0.5f, 0, 1, 0, 1, 0, 0, 1, 1, 0.2158605f, 0, 0, 1}, 4);
    const Mesh mesh = read_primitive(builder, square);
    EXPECT_EQ(mesh.format, "glTF");
    EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(mesh.normals[3], Vec3(0, 0, 1));
    EXPECT_EQ(mesh.vertex_uvs, (std::vector<Vec2>{{0, 1}, {1, 1}, {1, 0.25f}, {0, 0}})); // v points up
    EXPECT_EQ(mesh.vertex_colors[0], (Color{255, 0, 0, 128}));
    EXPECT_EQ(mesh.vertex_colors[3], (Color{128, 0, 0, 255})); // linear 0.2158605
    EXPECT_TRUE(mesh.warnings.empty());
}

TEST_F(GltfRead, ReadsBuffersBesideAndInTheFile) {
    GltfBuilder builder;
    builder.show({builder.add_node({{"mesh", builder.add_mesh({builder.square()})}})});
    const std::multiset<std::vector<double>> expected = triangles_of(read_built(builder));
    write("a buffer.bin", builder.bytes);
    EXPECT_EQ(triangles_of(read("scene.gltf", builder.gltf("a%20buffer.bin"))), expected);
    // "AAAA" is three zero bytes: a buffer of 48 + 12 bytes starts with the zeros of the first corner.
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text, bytes = builder.bytes;
    while (bytes.size() % 3 != 0)
        bytes.push_back('\0');
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto at = [&](std::size_t k) { return static_cast<unsigned>(static_cast<unsigned char>(bytes[i + k])); };
        const unsigned bits = at(0) << 16 | at(1) << 8 | at(2);
        for (const int shift : {18, 12, 6, 0})
            text.push_back(digits[bits >> shift & 63]);
    }
    EXPECT_EQ(triangles_of(read("scene.gltf", builder.gltf("data:application/octet-stream;base64," + text))), expected);
}

TEST_F(GltfRead, TransformsFollowTheNodes) {
    GltfBuilder builder;
    const std::size_t mesh = builder.add_mesh({cube(builder)}, "cube");
    // Scaled by 2, turned by 90 degrees around z, moved by (10, 0, 0), under a parent at (0, 5, 0).
    const double half = std::sqrt(0.5);
    const std::size_t child = builder.add_node(
        {{"mesh", mesh}, {"scale", {2, 2, 2}}, {"rotation", {0, 0, half, half}}, {"translation", {10, 0, 0}}});
    builder.show({builder.add_node({{"children", {child}}, {"translation", {0, 5, 0}}})});
    const Mesh read = read_built(builder);
    ASSERT_EQ(read.vertex_count(), 8u);
    const Vec3d moved = read.positions[1]; // (1, 0, 0) -> (2, 0, 0) -> (0, 2, 0) -> (10, 7, 0)
    EXPECT_LT(glm::distance(moved, Vec3d(10, 7, 0)), 1e-6);
    EXPECT_NEAR(diagnose(read).signed_volume, 8.0, 1e-5);
}

TEST_F(GltfRead, NegativeAndNonUniformScalesKeepTheFrontOutside) {
    GltfBuilder builder;
    Json primitive = cube(builder);
    std::vector<float> normals; // of a sphere
    for (std::size_t i = 0; i < cube_corners.size(); i += 3) {
        const Vec3 n =
            glm::normalize(Vec3(cube_corners[i] - 0.5f, cube_corners[i + 1] - 0.5f, cube_corners[i + 2] - 0.5f));
        normals.insert(normals.end(), {n.x, n.y, n.z});
    }
    primitive["attributes"]["NORMAL"] = builder.add(normals, 3);
    const std::size_t mesh = builder.add_mesh({primitive});
    builder.show({builder.add_node({{"mesh", mesh}, {"scale", {-1, 2, 3}}}),
                  builder.add_node({{"mesh", mesh}, {"matrix", {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 9, 0, 0, 1}}})});
    const Mesh read = read_built(builder);
    EXPECT_NEAR(diagnose(read).signed_volume, 6.0 + 1.0, 1e-5);
    for (std::size_t v = 0; v < 8; ++v) {
        const Vec3d from_center = read.positions[v] - Vec3d(-0.5, 1, 1.5);
        EXPECT_GT(glm::dot(from_center, Vec3d(read.normals[v])), 0.0);
        // The normal of a stretched sphere: divided by the square of the scale.
        const Vec3d expected = glm::normalize(from_center / Vec3d(1, 4, 9));
        EXPECT_LT(glm::distance(expected, Vec3d(read.normals[v])), 1e-6);
    }
}

TEST_F(GltfRead, StripsAndFansAreTriangles) {
    for (const auto& [mode, indices] :
         {std::pair<int, std::vector<std::uint8_t>>{5, {0, 1, 3, 2}}, {6, {0, 1, 2, 3}}}) {
        GltfBuilder builder;
        Json square = builder.square();
        square["mode"] = mode;
        square["indices"] = builder.add(indices);
        const Mesh mesh = read_primitive(builder, square);
        ASSERT_EQ(mesh.face_count(), 2u);
        EXPECT_NEAR(mesh.box().diagonal(), std::sqrt(2.0), 1e-12);
        for (std::size_t f = 0; f < 2; ++f) { // both face +z
            const auto face = mesh.face(f);
            const Vec3d n = glm::cross(mesh.positions[face[1]] - mesh.positions[face[0]],
                                       mesh.positions[face[2]] - mesh.positions[face[0]]);
            EXPECT_GT(n.z, 0.5) << mode;
        }
    }
}

TEST_F(GltfRead, WithoutIndicesTheVerticesFollowEachOther) {
    GltfBuilder builder;
    const Mesh mesh = read_primitive(
        builder,
        {{"attributes", {{"POSITION", builder.add(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5}, 3)}}}});
    EXPECT_EQ(mesh.corners, (std::vector<std::uint32_t>{0, 1, 2})); // the fourth is left over
    EXPECT_EQ(mesh.vertex_count(), 4u);
}

TEST_F(GltfRead, ReadsInterleavedSparseAndQuantizedAccessors) {
    GltfBuilder builder;
    const std::multiset<std::vector<double>> expected = triangles_of(read_primitive(builder, builder.square()));

    GltfBuilder interleaved; // position and something else
    const std::vector<float> rows{0, 0, 0, 9, 1, 0, 0, 9, 1, 1, 0, 9, 0, 1, 0, 9};
    Json square = interleaved.square();
    square["attributes"]["POSITION"] = interleaved.add_accessor(
        {{"bufferView", interleaved.add_view(rows, 16)}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}});
    EXPECT_EQ(triangles_of(read_primitive(interleaved, square)), expected);

    GltfBuilder sparse; // zeros, of which three are replaced
    square = sparse.square();
    square["attributes"]["POSITION"] = sparse.add_accessor(
        {{"componentType", 5126},
         {"count", 4},
         {"type", "VEC3"},
         {"sparse",
          {{"count", 3},
           {"indices", {{"bufferView", sparse.add_view(std::vector<std::uint8_t>{1, 2, 3})}, {"componentType", 5121}}},
           {"values", {{"bufferView", sparse.add_view(std::vector<float>{1, 0, 0, 1, 1, 0, 0, 1, 0})}}}}}});
    EXPECT_EQ(triangles_of(read_primitive(sparse, square)), expected);

    GltfBuilder quantized; // 32767 is 1; each position takes eight bytes
    const std::int16_t one = 32767;
    const std::vector<std::int16_t> shorts{0, 0, 0, 0, one, 0, 0, 0, one, one, 0, 0, 0, one, 0, 0};
    square = quantized.square();
    quantized.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    square["attributes"]["POSITION"] = quantized.add_accessor({{"bufferView", quantized.add_view(shorts, 8)},
                                                               {"componentType", 5122},
                                                               {"normalized", true},
                                                               {"count", 4},
                                                               {"type", "VEC3"}});
    EXPECT_EQ(triangles_of(read_primitive(quantized, square)), expected);
}

TEST_F(GltfRead, DecodesMeshopt) {
    GltfBuilder builder;
    const std::multiset<std::vector<double>> expected = triangles_of(read_primitive(builder, cube(builder)));
    GltfBuilder compressed;
    std::vector<unsigned char> vertices(meshopt_encodeVertexBufferBound(8, 12)),
        indices(meshopt_encodeIndexBufferBound(36, 8));
    vertices.resize(meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), cube_corners.data(), 8, 12));
    const std::vector<unsigned int> words(cube_indices.begin(), cube_indices.end());
    indices.resize(meshopt_encodeIndexBuffer(indices.data(), indices.size(), words.data(), 36));
    const auto view = [&](const std::vector<unsigned char>& bytes, std::size_t count, std::size_t stride,
                          const char* mode) {
        const std::size_t number = compressed.add_view(bytes);
        Json& made = compressed.json["bufferViews"][number];
        Json extension = made; // where the compressed bytes are
        extension["byteStride"] = stride;
        extension["count"] = count;
        extension["mode"] = mode;
        made["byteLength"] = count * stride;
        made["extensions"] = {{"EXT_meshopt_compression", extension}};
        return number;
    };
    const std::size_t positions = compressed.add_accessor(
        {{"bufferView", view(vertices, 8, 12, "ATTRIBUTES")}, {"componentType", 5126}, {"count", 8}, {"type", "VEC3"}});
    const std::size_t corners = compressed.add_accessor({{"bufferView", view(indices, 36, 2, "TRIANGLES")},
                                                         {"componentType", 5123},
                                                         {"count", 36},
                                                         {"type", "SCALAR"}});
    compressed.json["extensionsRequired"] = {"EXT_meshopt_compression"};
    EXPECT_EQ(
        triangles_of(read_primitive(compressed, {{"attributes", {{"POSITION", positions}}}, {"indices", corners}})),
        expected);
    compressed.bytes[3] = static_cast<char>(compressed.bytes[3] ^ 0x55);
    compressed.bytes.replace(0, 4, "xxxx");
    expect_has(refusal(compressed), "EXT_meshopt_compression: the compressed data is damaged");
}

TEST_F(GltfRead, DecodesDraco) {
    GltfBuilder builder;
    const std::multiset<std::vector<double>> expected = triangles_of(read_primitive(builder, cube(builder)));
    draco::Mesh mesh;
    mesh.set_num_points(8);
    draco::GeometryAttribute attribute;
    attribute.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
    const int id = mesh.AddAttribute(attribute, true, 8);
    for (std::uint32_t v = 0; v < 8; ++v)
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v), cube_corners.data() + std::size_t(3) * v);
    mesh.SetNumFaces(12);
    for (std::uint32_t f = 0; f < 12; ++f) {
        draco::Mesh::Face face;
        for (std::uint32_t k = 0; k < 3; ++k)
            face[k] = draco::PointIndex(cube_indices[std::size_t(3) * f + k]);
        mesh.SetFace(draco::FaceIndex(f), face);
    }
    draco::Encoder encoder;
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
    draco::EncoderBuffer encoded;
    ASSERT_TRUE(encoder.EncodeMeshToBuffer(mesh, &encoded).ok());
    GltfBuilder compressed;
    const std::size_t view = compressed.add_view(std::vector<char>(encoded.data(), encoded.data() + encoded.size()));
    compressed.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    const Json primitive = {
        {"attributes",
         {{"POSITION", compressed.add_accessor({{"componentType", 5126}, {"count", 8}, {"type", "VEC3"}})}}},
        {"indices", compressed.add_accessor({{"componentType", 5123}, {"count", 36}, {"type", "SCALAR"}})},
        {"extensions",
         {{"KHR_draco_mesh_compression",
           {{"bufferView", view}, {"attributes", {{"POSITION", mesh.attribute(id)->unique_id()}}}}}}}};
    const Mesh read = read_primitive(compressed, primitive);
    ASSERT_EQ(read.vertex_count(), 8u);
    Mesh rounded = read;
    for (Vec3d& p : rounded.positions) { // quantized to 1 / 2^14
        EXPECT_LT(glm::distance(p, glm::round(p)), 2e-4);
        p = glm::round(p);
    }
    EXPECT_EQ(triangles_of(rounded), expected);
    Json& ids = compressed.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"];
    ids["TEXCOORD_0"] = ids["POSITION"];
    expect_has(refusal(compressed), "TEXCOORD_0 has 3 components");
    ids.erase("TEXCOORD_0");
    compressed.bytes.resize(compressed.bytes.size() - encoded.size() / 2);
    expect_has(refusal(compressed), "bufferViews[0]");
    compressed.bytes.resize(compressed.bytes.size() + encoded.size(), 'x');
    expect_has(refusal(compressed), "KHR_draco_mesh_compression: ");
}

TEST_F(GltfRead, InstancesAreVerticesOfTheirOwn) {
    GltfBuilder builder;
    const std::size_t mesh = builder.add_mesh({builder.square()});
    const std::size_t offsets = builder.add(std::vector<float>{0, 0, 0, 0, 0, 5}, 3);
    const std::size_t scales = builder.add(std::vector<float>{1, 1, 1, 2, 2, 2}, 3);
    builder.show({builder.add_node(
        {{"mesh", mesh},
         {"translation", {1, 0, 0}},
         {"extensions",
          {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", offsets}, {"SCALE", scales}}}}}}}})});
    const Mesh read = read_built(builder);
    ASSERT_EQ(read.vertex_count(), 8u);
    EXPECT_EQ(read.positions[2], Vec3d(2, 1, 0));
    EXPECT_EQ(read.positions[6], Vec3d(3, 2, 5));
}

TEST_F(GltfRead, PrimitivesWithTheSameAttributesShareVertices) {
    GltfBuilder builder;
    Json first = builder.square(), second = first;
    first["indices"] = builder.add(std::vector<std::uint8_t>{0, 1, 2});
    second["indices"] = builder.add(std::vector<std::uint8_t>{0, 2, 3});
    builder.show({builder.add_node({{"mesh", builder.add_mesh({first, second})}})});
    const Mesh mesh = read_built(builder);
    EXPECT_EQ(mesh.vertex_count(), 4u);
    EXPECT_EQ(mesh.face_count(), 2u);
}

TEST_F(GltfRead, GroupsHaveTheNamesOfNodesMeshesAndMaterials) {
    GltfBuilder builder;
    builder.json["materials"] = Json::array({{{"name", "steel"}}, {{"name", "glass"}, {"alphaMode", "BLEND"}}});
    Json steel = builder.square(), glass = builder.square();
    steel["material"] = 0;
    glass["material"] = 1;
    const std::size_t window =
        builder.add_node({{"name", "window"}, {"mesh", builder.add_mesh({steel, glass}, "frame")}});
    builder.show({builder.add_node({{"name", "house"}, {"children", {window}}})});
    const Mesh mesh = read_built(builder);
    ASSERT_EQ(mesh.groups.size(), 2u);
    EXPECT_EQ(mesh.groups[0].names, (std::vector<std::string>{"window", "house", "frame", "steel"}));
    EXPECT_EQ(mesh.groups[1].names.back(), "glass");
    EXPECT_EQ(mesh.groups[1].first_face, 2u);
    EXPECT_FALSE(mesh.groups[0].see_through);
    EXPECT_TRUE(mesh.groups[1].see_through);
}

TEST_F(GltfRead, OnlyTheDefaultSceneIsRead) {
    GltfBuilder builder;
    const std::size_t mesh = builder.add_mesh({builder.square()});
    const std::size_t a = builder.add_node({{"mesh", mesh}}),
                      b = builder.add_node({{"mesh", mesh}, {"translation", {7, 0, 0}}});
    builder.json["scenes"] = {{{"nodes", {a}}}, {{"nodes", {b}}}};
    EXPECT_EQ(read_built(builder).positions[0].x, 0.0);
    builder.json["scene"] = 1;
    EXPECT_EQ(read_built(builder).positions[0].x, 7.0);
    builder.json.erase("scene");
    builder.json.erase("scenes");
    EXPECT_EQ(read_built(builder).vertex_count(), 8u); // all root nodes
}

TEST_F(GltfRead, SkinsAndMorphTargetsAreReportedAndBakedWithout) {
    GltfBuilder builder;
    Json square = builder.square();
    square["targets"] = {{{"POSITION", square["attributes"]["POSITION"]}}};
    const std::vector<float> inverse{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -3, 0, 0, 1};
    const std::size_t matrices = builder.add_accessor(
        {{"bufferView", builder.add_view(inverse)}, {"componentType", 5126}, {"count", 1}, {"type", "MAT4"}});
    const std::size_t joint = builder.add_node({{"translation", {5, 0, 0}}});
    const std::size_t body =
        builder.add_node({{"mesh", builder.add_mesh({square})}, {"skin", 0}, {"translation", {100, 0, 0}}});
    builder.json["skins"] = {{{"joints", {joint}}, {"inverseBindMatrices", matrices}}};
    builder.show({joint, body});
    const Mesh mesh = read_built(builder);
    EXPECT_EQ(mesh.positions[0], Vec3d(2, 0, 0)); // the joint moved it by 5 - 3; the node does not count
    ASSERT_EQ(mesh.warnings.size(), 2u);
    expect_has(mesh.warnings[0], "1 mesh is deformed by a skeleton");
    expect_has(mesh.warnings[1], "1 primitive has morph targets");
}

TEST_F(GltfRead, LinesAndPointsAreCounted) {
    GltfBuilder builder;
    Json line = builder.square();
    line["mode"] = 1;
    builder.show({builder.add_node({{"mesh", builder.add_mesh({line, builder.square()})}})});
    const Mesh mesh = read_built(builder);
    EXPECT_EQ(mesh.face_count(), 2u);
    ASSERT_EQ(mesh.warnings.size(), 1u);
    expect_has(mesh.warnings[0], "1 primitive is points or lines");
}

TEST_F(GltfRead, CoordinatesAreRoundedToFloats) {
    GltfBuilder builder;
    builder.show({builder.add_node({{"mesh", builder.add_mesh({cube(builder)})}, {"translation", {0.1, 0.7, 11.3}}})});
    for (const Vec3d& p : read_built(builder).positions)
        for (int axis = 0; axis < 3; ++axis) {
            const volatile auto single = static_cast<float>(p[axis]);
            EXPECT_EQ(static_cast<double>(single), p[axis]);
        }
}

TEST_F(GltfRead, CoordinatesThatFloatsCannotHoldStayExact) {
    GltfBuilder builder;
    builder.show({builder.add_node({{"mesh", builder.add_mesh({cube(builder)})}, {"translation", {1e9, 0, 0}}})});
    EXPECT_EQ(read_built(builder).positions[1].x, 1e9 + 1.0);
}

TEST_F(GltfRead, RefusesDamageWithItsPlace) {
    const auto with = [&](const std::function<void(GltfBuilder&)>& change) {
        GltfBuilder builder;
        builder.show({builder.add_node({{"mesh", builder.add_mesh({builder.square()})}})});
        change(builder);
        return refusal(builder);
    };
    expect_has(with([](GltfBuilder& b) { b.json["asset"]["version"] = "1.0"; }), "version '1.0' cannot be read");
    expect_has(with([](GltfBuilder& b) { b.json["nodes"][0]["mesh"] = 7; }),
               "nodes[0].mesh: is 7, but there are only 1");
    expect_has(with([](GltfBuilder& b) { b.json["nodes"][0]["mesh"] = "no"; }), "nodes[0].mesh: is not a whole number");
    expect_has(with([](GltfBuilder& b) { b.json["nodes"][0]["children"] = {0}; }), "its own ancestor");
    expect_has(with([](GltfBuilder& b) { b.json["nodes"][0]["matrix"] = {1, 2}; }), "has 2 numbers, not 16");
    expect_has(with([](GltfBuilder& b) { b.json["accessors"][0]["count"] = 5; }), "do not fit its buffer view");
    expect_has(with([](GltfBuilder& b) { b.json["accessors"][0]["byteOffset"] = 1e14; }), "do not fit its buffer view");
    expect_has(with([](GltfBuilder& b) { b.json["accessors"][0]["componentType"] = 1; }), "not a component type");
    expect_has(with([](GltfBuilder& b) { b.json["bufferViews"][0]["byteLength"] = 1e9; }), "exceed the buffer");
    expect_has(with([](GltfBuilder& b) { b.json["bufferViews"][0]["byteStride"] = 4; }), "less than an element");
    expect_has(with([](GltfBuilder& b) { b.bytes[b.bytes.size() - 2] = 9; }),
               "meshes[0].primitives[0].indices: element 5 is 9, but there are 4 vertices");
    expect_has(with([](GltfBuilder& b) { b.json["extensionsRequired"] = {"ACME_curves"}; }), "needs 'ACME_curves'");
    expect_has(with([](GltfBuilder& b) { b.json["extensionsRequired"] = {"KHR_materials_unlit"}; }), "");
    expect_has(with([](GltfBuilder& b) { // more than any memory
                   b.json["accessors"][0].erase("bufferView");
                   b.json["accessors"][0]["count"] = 4e9;
               }),
               "--max-memory");
}

TEST_F(GltfRead, RefusesCyclesAndSecondParents) {
    GltfBuilder builder;
    builder.add_node({{"children", {1}}});
    builder.add_node({{"children", {0}}, {"mesh", builder.add_mesh({builder.square()})}});
    builder.show({0});
    EXPECT_EQ(read_built(builder).vertex_count(), 4u); // each node once
    builder.json["nodes"].push_back({{"children", {1}}});
    expect_has(refusal(builder), "has two parents");
}

TEST_F(GltfRead, ReadsNoFilesOutsideItsFolder) {
    GltfBuilder builder;
    builder.show({builder.add_node({{"mesh", builder.add_mesh({builder.square()})}})});
    for (const char* uri : {"../secret.bin", "/etc/passwd", "file:///etc/passwd", "http://example.com/a.bin",
                            "a/../../secret.bin", "%2e%2e/secret.bin", "..\\secret.bin", "", "C:/secret.bin"})
        expect_has(refusal(builder.gltf(uri), "scene.gltf"), "is not a file in the folder of this one");
    expect_has(refusal(builder.gltf("missing.bin"), "scene.gltf"), "missing.bin");
    write("short.bin", "0123");
    expect_has(refusal(builder.gltf("short.bin"), "scene.gltf"), "has 4 bytes, fewer than its byteLength");
    expect_has(refusal(builder.gltf("data:;base64,####"), "scene.gltf"), "not a data URI in base64");
}

TEST_F(GltfRead, RefusesDeepAndBrokenJson) {
    std::string deep = R"({"asset": {"version": "2.0"}, "extras": )";
    deep += std::string(100000, '[') + std::string(100000, ']') + "}";
    expect_has(refusal(deep, "scene.gltf"), "nested more than 200 levels deep");
    expect_has(refusal("{\n\"asset\": {\"version\": \"2.0\"},\n oops }", "scene.gltf"), "line 3: the JSON is damaged");
    expect_has(refusal("glTF\2", "scene.glb"), "ends early");
    GltfBuilder builder;
    builder.show({builder.add_node({{"mesh", builder.add_mesh({builder.square()})}})});
    std::string cut = builder.glb();
    cut.resize(cut.size() / 2);
    expect_has(refusal(cut), "the header gives a length");
}

TEST_F(GltfRead, AnEmptySceneIsRefused) {
    GltfBuilder builder;
    builder.show({});
    expect_has(refusal(builder), "no mesh in its scene");
}
