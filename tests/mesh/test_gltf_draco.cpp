/// Values of meshes that Draco compressed.
#include "gltf_builder.h"
#include "scratch_files.h"

#include <draco/compression/encode.h>

using namespace alcove;
using Json = GltfBuilder::Json;

namespace {

using GltfDraco = ScratchFiles;

/// A triangle, compressed.
Json draco_triangle(GltfBuilder& builder) {
    const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0};
    draco::Mesh mesh;
    mesh.set_num_points(3);
    draco::GeometryAttribute attribute;
    attribute.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
    const int id = mesh.AddAttribute(attribute, true, 3);
    for (std::uint32_t v = 0; v < 3; ++v)
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v), corners.data() + std::size_t(3) * v);
    mesh.SetNumFaces(1);
    mesh.SetFace(draco::FaceIndex(0), {draco::PointIndex(0), draco::PointIndex(1), draco::PointIndex(2)});
    draco::Encoder encoder;
    draco::EncoderBuffer encoded;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &encoded).ok());
    const std::size_t view = builder.add_view(std::vector<char>(encoded.data(), encoded.data() + encoded.size()));
    builder.json["extensionsUsed"] = builder.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return {
        {"attributes", {{"POSITION", builder.add_accessor({{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}})}}},
        {"indices", builder.add_accessor({{"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}})},
        {"extensions",
         {{"KHR_draco_mesh_compression",
           {{"bufferView", view}, {"attributes", {{"POSITION", mesh.attribute(id)->unique_id()}}}}}}}};
}

/// three.js gives all primitives with the same compressed buffer view the values of only one of them.
TEST_F(GltfDraco, CopiesHaveTheirOwnViewOfTheSameBytes) {
    GltfBuilder builder;
    const std::size_t mesh = builder.add_mesh({draco_triangle(builder)});
    builder.show({builder.add_node({{"mesh", mesh}}), builder.add_node({{"mesh", mesh}, {"translation", {5, 0, 0}}})});
    Mesh scene = read("in.glb", builder.glb());
    for (const bool differ : {false, true}) {
        scene.set_attribute({"ao", 1, {0, 0, 0, differ ? 1.0f : 0.0f, 0, 0}});
        write_mesh(scene, path("out.glb"));
        const std::string bytes = bytes_of("out.glb");
        std::uint32_t length = 0;
        std::memcpy(&length, bytes.data() + 12, sizeof(length));
        const Json json = Json::parse(bytes.substr(20, length));
        ASSERT_EQ(json["meshes"].size(), differ ? 2u : 1u);
        const auto view = [&](std::size_t m) {
            return json["meshes"][m]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["bufferView"]
                .get<std::size_t>();
        };
        EXPECT_EQ(view(0), 0u);
        if (differ) {
            EXPECT_NE(view(1), 0u);
            EXPECT_EQ(json["bufferViews"][view(1)], json["bufferViews"][0]);
        }
        EXPECT_EQ(read_mesh(path("out.glb")).positions, scene.positions);
    }
}

}
