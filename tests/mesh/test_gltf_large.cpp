/// Large .glb files, whose data stays on the disk while they are processed.
#include "gltf_builder.h"
#include "scratch_files.h"

#include "alcove/base/types.h"
#include "alcove/mesh/detail/source.h"
#include "alcove/mesh/formats/formats.h"

#include <chrono>
#include <cmath>

using namespace alcove;
using Json = GltfBuilder::Json;

namespace {

constexpr std::size_t width = 150; // of squares of vertices; enough for several blocks

template <class T>
std::vector<T> indices_of_grid() {
    std::vector<T> indices;
    for (std::size_t v = 0; v + width + 1 < width * width; ++v)
        if (v % width + 1 < width)
            for (const std::size_t i : {v, v + 1, v + width + 1, v, v + width + 1, v + width})
                indices.push_back(static_cast<T>(i));
    return indices;
}

class GltfLarge : public ScratchFiles {
  protected:
    /// `components` values for each vertex of a square.
    static std::vector<float> values(std::size_t components, float scale) {
        std::vector<float> values;
        for (std::size_t v = 0; v < width * width; ++v)
            for (std::size_t c = 0; c < components; ++c)
                values.push_back(scale * std::fabs(std::sin(0.37f * static_cast<float>(v * (c + 1)))));
        return values;
    }
    /// Primitives of all kinds, in a mesh that is placed once and in one that is placed twice.
    static GltfBuilder scene() {
        GltfBuilder builder;
        Json floats = {{"attributes",
                        {{"POSITION", builder.add(values(3, 2.0f), 3)},
                         {"NORMAL", builder.add(values(3, 1.0f), 3)},
                         {"TEXCOORD_0", builder.add(values(2, 1.0f), 2)},
                         {"COLOR_0", builder.add(values(4, 1.0f), 4)}}},
                       {"indices", builder.add(indices_of_grid<std::uint32_t>())}};
        const std::size_t view = builder.add_view(values(6, 1.0f), 24);
        const auto interleaved = [&](std::size_t offset) {
            return builder.add_accessor({{"bufferView", view},
                                         {"byteOffset", offset},
                                         {"componentType", 5126},
                                         {"count", width * width},
                                         {"type", "VEC3"}});
        };
        Json rows = {{"attributes", {{"POSITION", interleaved(0)}, {"NORMAL", interleaved(12)}}},
                     {"indices", builder.add(indices_of_grid<std::uint16_t>())}};
        builder.json["accessors"][rows["indices"].get<std::size_t>()]["sparse"] = {
            {"count", 2},
            {"indices", {{"bufferView", builder.add_view(std::vector<std::uint16_t>{3, 4})}, {"componentType", 5123}}},
            {"values", {{"bufferView", builder.add_view(std::vector<std::uint16_t>{7, 8})}}}};
        Json strip = {{"attributes", {{"POSITION", builder.add(values(3, 3.0f), 3)}}}, {"mode", 5}};
        const std::size_t once = builder.add_mesh({std::move(floats), std::move(strip)});
        const std::size_t twice = builder.add_mesh({std::move(rows)});
        builder.show({builder.add_node({{"mesh", once}}), builder.add_node({{"mesh", twice}}),
                      builder.add_node({{"mesh", twice}, {"scale", {-1, 2, 0.3}}})});
        return builder;
    }
    /// With a chunk after the binary one.
    static std::string bytes_of_scene() {
        std::string bytes = scene().glb() + packed(std::uint32_t(4), std::uint32_t(0x4d4f4f46)) + "abcd";
        const auto length = static_cast<std::uint32_t>(bytes.size());
        std::memcpy(bytes.data() + 8, &length, 4);
        EXPECT_GT(bytes.size(), std::size_t{1} << 20);
        return bytes;
    }
    /// Adds values, and writes the mesh.
    void bake(Mesh mesh, const std::string& name) const {
        std::vector<float> ao(mesh.vertex_count());
        for (std::size_t v = 0; v < ao.size(); ++v)
            ao[v] = static_cast<float>(v % 97) / 96.0f;
        mesh.set_attribute({"ao", 1, ao});
        mesh.added_comments = {"alcove 0: ao"};
        write_mesh(mesh, path(name));
    }
    void touch(const std::string& name) const {
        std::filesystem::last_write_time(path(name),
                                         std::filesystem::last_write_time(path(name)) + std::chrono::seconds(1));
    }
    template <class Work>
    static std::string refusal(const Work& work) {
        try {
            work();
        } catch (const InputError& error) {
            return error.what();
        }
        return "nothing was thrown";
    }
    static void expect_has(const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << text << "\nlacks: " << part;
    }
};

}

TEST_F(GltfLarge, IsTheSameFromDiskAndFromMemory) {
    const std::string bytes = bytes_of_scene();
    const Mesh on_disk = read("in.glb", bytes), in_memory = read_bytes(FileBytes(path("in.glb"), bytes));
    EXPECT_EQ(on_disk.positions, in_memory.positions);
    EXPECT_EQ(on_disk.normals, in_memory.normals);
    EXPECT_EQ(on_disk.vertex_uvs, in_memory.vertex_uvs);
    EXPECT_EQ(on_disk.vertex_colors, in_memory.vertex_colors);
    EXPECT_EQ(on_disk.face_begin, in_memory.face_begin);
    EXPECT_EQ(on_disk.corners, in_memory.corners);
    EXPECT_EQ(on_disk.source->uv_set(0), in_memory.source->uv_set(0));
    EXPECT_EQ(on_disk.vertex_count(), 4 * width * width);
    write_mesh(on_disk, path("out.glb"));
    EXPECT_EQ(bytes_of("out.glb"), bytes);
    for (const std::string name : {"out.glb", "out.gltf"}) {
        bake(on_disk, "disk " + name);
        bake(in_memory, "memory " + name);
        EXPECT_EQ(bytes_of("disk " + name), bytes_of("memory " + name));
        EXPECT_GT(bytes_of("disk " + name).size(), bytes.size());
        bake(read_mesh(path("disk " + name)), "again " + name);
        EXPECT_EQ(bytes_of("again " + name), bytes_of("disk " + name));
    }
}

TEST_F(GltfLarge, HasTheValuesOfItsBuffers) {
    const Mesh mesh = read("in.glb", bytes_of_scene());
    const std::vector<float> positions = values(3, 2.0f), uvs = values(2, 1.0f);
    for (std::size_t v = 0; v < width * width; ++v) {
        EXPECT_EQ(mesh.positions[v], Vec3d(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]));
        EXPECT_EQ(mesh.vertex_uvs[v], Vec2(uvs[2 * v], 1.0f - uvs[2 * v + 1]));
    }
    const std::vector<std::uint32_t> indices = indices_of_grid<std::uint32_t>();
    EXPECT_TRUE(std::equal(indices.begin(), indices.end(), mesh.corners.begin()));
}

TEST_F(GltfLarge, MayBeReplacedWhileItIsOpen) {
    const std::string bytes = bytes_of_scene();
    const Mesh mesh = read("scene.glb", bytes);
    bake(mesh, "scene.glb");
    write_mesh(mesh, path("copy.glb"));
    EXPECT_EQ(bytes_of("copy.glb"), bytes);
}

TEST_F(GltfLarge, IsRefusedIfItChangesBeforeItIsWritten) {
    const std::string bytes = bytes_of_scene(), wanted = "was changed while it was being processed; run again";
    const Mesh mesh = read("in.glb", bytes);
    const auto refused = [&] { return refusal([&] { write_mesh(mesh, path("out.glb")); }); };
    touch("in.glb");
    EXPECT_EQ(refused(), path("in.glb").string() + ": " + wanted);
    std::filesystem::resize_file(path("in.glb"), bytes.size() / 2);
    expect_has(refused(), wanted);
    expect_has(refusal([&] { (void)mesh.source->uv_set(0); }), wanted);
    EXPECT_FALSE(std::filesystem::exists(path("out.glb")));
}

TEST_F(GltfLarge, IsRefusedIfItIsDamaged) {
    const auto refused = [&](const std::string& bytes) { return refusal([&] { read("in.glb", bytes); }); };
    const std::string bytes = bytes_of_scene();
    expect_has(refused(bytes.substr(0, bytes.size() - 5)), "byte 12: the header gives a length of");
    std::string cut = bytes.substr(0, bytes.size() - 7); // in the header of the last chunk
    const auto length = static_cast<std::uint32_t>(cut.size());
    std::memcpy(cut.data() + 8, &length, 4);
    expect_has(refused(cut), "the file ends early: the type of a chunk is missing");
    cut.resize(cut.size() - 100); // in the binary chunk
    const auto shorter = static_cast<std::uint32_t>(cut.size());
    std::memcpy(cut.data() + 8, &shorter, 4);
    expect_has(refused(cut), "does not fit the rest of the file");
    GltfBuilder builder = scene();
    const Json& indices = builder.json["bufferViews"][4]; // of the first primitive
    const std::size_t last = indices["byteOffset"].get<std::size_t>() + indices["byteLength"].get<std::size_t>() - 4;
    builder.bytes.replace(last, 4, packed(std::uint32_t(width * width)));
    expect_has(refused(builder.glb()), "is 22500, but there are 22,500 vertices");
}
