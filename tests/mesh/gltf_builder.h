/// Builds small glTF files for tests.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <vector>

/// JSON and a binary chunk, to which buffer views and accessors are appended.
class GltfBuilder {
  public:
    using Json = nlohmann::ordered_json;

    GltfBuilder() { json["asset"] = {{"version", "2.0"}}; }

    template <class T>
    std::size_t add_view(const std::vector<T>& values, std::size_t stride = 0) {
        bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
        Json view = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}};
        if (stride > 0)
            view["byteStride"] = stride;
        bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        json["bufferViews"].push_back(std::move(view));
        return json["bufferViews"].size() - 1;
    }

    /// Adds an accessor whose elements have `components` values each. \return its index.
    template <class T>
    std::size_t add(const std::vector<T>& values, std::size_t components = 1) {
        const char* const types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
        return add_accessor({{"bufferView", add_view(values)},
                             {"componentType", component_type(T())},
                             {"count", values.size() / components},
                             {"type", types[components - 1]}});
    }
    std::size_t add_accessor(Json accessor) {
        json["accessors"].push_back(std::move(accessor));
        return json["accessors"].size() - 1;
    }

    std::size_t add_mesh(Json primitives, const std::string& name = "") {
        Json mesh = {{"primitives", std::move(primitives)}};
        if (!name.empty())
            mesh["name"] = name;
        json["meshes"].push_back(std::move(mesh));
        return json["meshes"].size() - 1;
    }
    std::size_t add_node(Json node) {
        json["nodes"].push_back(std::move(node));
        return json["nodes"].size() - 1;
    }
    /// Sets the only scene, which consists of these nodes.
    void show(const std::vector<std::size_t>& nodes) { json["scenes"] = {{{"nodes", nodes}}}; }

    /// A unit square in the plane z = 0 that faces +z, and its accessors.
    Json square() {
        const std::vector<float> corners{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
        const std::vector<std::uint16_t> indices{0, 1, 2, 0, 2, 3};
        return {{"attributes", {{"POSITION", add(corners, 3)}}}, {"indices", add(indices)}};
    }

    std::string glb() {
        finish();
        std::string text = json.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string binary = bytes;
        binary.resize((binary.size() + 3) / 4 * 4, '\0');
        return "glTF" + number(2) + number(28 + text.size() + binary.size()) + number(text.size()) + "JSON" + text +
               number(binary.size()) + std::string("BIN\0", 4) + binary;
    }
    /// The JSON alone, with the buffer in a file of that name.
    std::string gltf(const std::string& buffer) {
        finish();
        json["buffers"][0]["uri"] = buffer;
        return json.dump(2);
    }

    Json json;
    std::string bytes;

  private:
    void finish() {
        if (!bytes.empty())
            json["buffers"] = Json::array({{{"byteLength", bytes.size()}}});
    }
    static std::string number(std::size_t value) {
        const auto word = static_cast<std::uint32_t>(value);
        return std::string(reinterpret_cast<const char*>(&word), sizeof(word));
    }
    static int component_type(std::int8_t) { return 5120; }
    static int component_type(std::uint8_t) { return 5121; }
    static int component_type(std::int16_t) { return 5122; }
    static int component_type(std::uint16_t) { return 5123; }
    static int component_type(std::uint32_t) { return 5125; }
    static int component_type(float) { return 5126; }
};
