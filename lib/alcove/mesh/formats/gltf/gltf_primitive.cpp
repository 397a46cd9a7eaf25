#include "alcove/mesh/formats/gltf/gltf_primitive.h"

#include "alcove/base/detail/messages.h"
#include "alcove/mesh/formats/gltf/gltf_accessor.h"
#include "alcove/mesh/formats/gltf/gltf_compression.h"
#include "alcove/mesh/formats/gltf/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>

namespace alcove {
namespace {

enum Mode : std::size_t { triangles = 4, triangle_strip, triangle_fan };

std::optional<GltfValue> draco_of(const GltfValue& primitive) {
    const std::optional<GltfValue> extensions = primitive.find("extensions");
    return extensions ? extensions->find("KHR_draco_mesh_compression") : std::nullopt;
}

std::size_t mode_of(const GltfValue& primitive) {
    return primitive.count_or("mode", triangles);
}

/// Moves an attribute out of a decoded primitive. Returns an empty array if the primitive does not have it.
GltfArray<float> take_attribute(DracoMesh& mesh, const GltfValue& extension, const std::string& name, int least,
                                int most) {
    const auto found = mesh.attributes.find(name);
    if (found == mesh.attributes.end())
        return {};
    if (found->second.components < least || found->second.components > most)
        extension.fail(fmt::format("{} has {} components; export the file again", name, found->second.components));
    return GltfArray<float>(std::move(found->second.floats));
}

std::size_t vertex_count_of(const GltfFile& file, const GltfValue& primitive) {
    return count_of_accessor(*accessor_of(file.root(), primitive, "POSITION"));
}

/// The values of an attribute that is not compressed with Draco; empty if the primitive does not have it.
GltfArray<float> floats_of(GltfFile& file, const GltfValue& primitive, const std::string& name, int least, int most,
                           int* components = nullptr) {
    const std::optional<GltfValue> value = accessor_of(file.root(), primitive, name.c_str());
    if (!value)
        return {};
    const GltfAccessor accessor(file, *value, least, most);
    if (const std::size_t count = vertex_count_of(file, primitive); accessor.count() != count)
        value->fail(fmt::format("{} has {} elements, but POSITION has {}; export the file again", name,
                                grouped(accessor.count()), grouped(count)));
    if (components != nullptr)
        *components = accessor.components();
    return accessor.floats();
}

GltfPrimitives decompressed(GltfFile& file, const GltfValue& primitive, const GltfValue& extension) {
    DracoMesh draco = decode_draco(file, extension);
    GltfPrimitives vertices;
    const auto take = [&](const char* name, int least, int most) {
        return take_attribute(draco, extension, name, least, most);
    };
    vertices.positions = take("POSITION", 3, 3);
    vertices.normals = take("NORMAL", 3, 3);
    if (const auto colors = draco.attributes.find("COLOR_0"); colors != draco.attributes.end())
        vertices.color_components = colors->second.components;
    vertices.colors = take("COLOR_0", 3, 4);
    vertices.uvs = take("TEXCOORD_0", 2, 2);
    // Read the attributes that are not compressed.
    if (vertices.normals.empty())
        vertices.normals = floats_of(file, primitive, "NORMAL", 3, 3);
    if (vertices.colors.empty())
        vertices.colors = floats_of(file, primitive, "COLOR_0", 3, 4, &vertices.color_components);
    if (vertices.uvs.empty() && !extension["attributes"].has("TEXCOORD_0"))
        vertices.uvs = floats_of(file, primitive, "TEXCOORD_0", 2, 2);
    if (vertices.positions.empty())
        extension.fail("has no POSITION; export the file again");
    // Added values are written for each vertex of the accessor, so the counts must agree.
    if (const std::size_t count = vertex_count_of(file, primitive); count != vertices.count())
        extension.fail(fmt::format("has {} vertices, but POSITION has {}; export the file again",
                                   grouped(vertices.count()), grouped(count)));
    vertices.corners.emplace_back(std::move(draco.indices));
    return vertices;
}

/// The first index that is not below `limit`, or the end.
auto first_above(std::span<std::uint32_t> indices, std::size_t limit) {
    std::uint32_t largest = 0; // computed first, because a loop without an early exit is fast
    for (const std::uint32_t index : indices)
        largest = std::max(largest, index);
    return largest < limit ? indices.end()
                           : std::find_if(indices.begin(), indices.end(), [&](std::uint32_t i) { return i >= limit; });
}

/// The indices of a primitive. Refuses those out of range as soon as they are decoded.
GltfArray<std::uint32_t> indices_of(GltfFile& file, const GltfValue& primitive, std::size_t vertex_count) {
    if (!primitive.has("indices"))
        return {vertex_count, [](std::size_t first, std::span<std::uint32_t> to) {
                    std::iota(to.begin(), to.end(), static_cast<std::uint32_t>(first));
                }};
    const GltfValue place = primitive["indices"];
    GltfArray<std::uint32_t> indices = GltfAccessor(file, place.target(file.root(), "accessors"), 1, 1).indices();
    const std::size_t count = indices.size();
    return {count, [indices = std::move(indices), place, vertex_count](std::size_t first, std::span<std::uint32_t> to) {
                indices.decode(first, to);
                const auto too_large = first_above(to, vertex_count);
                if (too_large != to.end())
                    place.fail(fmt::format("element {} is {}, but there are {} vertices; export the file again",
                                           grouped(first + static_cast<std::size_t>(too_large - to.begin())),
                                           *too_large, grouped(vertex_count)));
            }};
}

/// The corners of the triangles of a strip or fan. Degenerate triangles are dropped, as they only connect parts.
std::vector<std::uint32_t> as_triangles(const std::vector<std::uint32_t>& indices, std::size_t mode) {
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 2; i < indices.size(); ++i) {
        const std::uint32_t c = indices[i];
        std::uint32_t a = indices[mode == triangle_fan ? 0 : i - 2], b = indices[i - 1];
        if (mode == triangle_strip && i % 2 == 1)
            std::swap(a, b);
        if (a != b && b != c && a != c)
            corners.insert(corners.end(), {a, b, c});
    }
    return corners;
}

}

void GltfPrimitives::keep() {
    for (GltfArray<std::uint32_t>& of_primitive : corners)
        of_primitive.keep();
    for (GltfArray<float>* const floats : {&positions, &normals, &colors, &uvs})
        floats->keep();
}

bool is_surface(const GltfValue& primitive) {
    const std::size_t mode = mode_of(primitive);
    return mode >= triangles && mode <= triangle_fan && primitive["attributes"].has("POSITION");
}

bool is_draco(const GltfValue& primitive) {
    return draco_of(primitive).has_value();
}

std::optional<GltfValue> accessor_of(const GltfValue& root, const GltfValue& primitive, const char* attribute) {
    const GltfValue attributes = primitive["attributes"];
    if (!attributes.has(attribute))
        return {};
    return attributes[attribute].target(root, "accessors");
}

double most_corners(const GltfValue& root, const GltfValue& primitive, std::size_t vertex_count) {
    const std::size_t count =
        primitive.has("indices") ? count_of_accessor(primitive["indices"].target(root, "accessors")) : vertex_count;
    return (mode_of(primitive) == triangles ? 1.0 : 3.0) * static_cast<double>(count);
}

GltfPrimitives vertices_of(GltfFile& file, const GltfValue& primitive) {
    if (const std::optional<GltfValue> draco = draco_of(primitive))
        return decompressed(file, primitive, *draco);
    GltfPrimitives vertices;
    vertices.positions = floats_of(file, primitive, "POSITION", 3, 3);
    vertices.normals = floats_of(file, primitive, "NORMAL", 3, 3);
    vertices.colors = floats_of(file, primitive, "COLOR_0", 3, 4, &vertices.color_components);
    vertices.uvs = floats_of(file, primitive, "TEXCOORD_0", 2, 2);
    return vertices;
}

GltfArray<std::uint32_t> corners_of(GltfFile& file, const GltfValue& primitive, std::size_t vertex_count) {
    GltfArray<std::uint32_t> indices = indices_of(file, primitive, vertex_count);
    const std::size_t mode = mode_of(primitive);
    if (mode != triangles)
        return GltfArray<std::uint32_t>(as_triangles(indices.all(), mode));
    const std::size_t count = indices.size() / 3 * 3;
    std::array<std::uint32_t, 2> rest{}; // dropped, but must be in range, too
    indices.decode(count, std::span(rest).first(indices.size() - count));
    indices.cut(count);
    return indices;
}

std::vector<Vec2> uvs_of_primitive(GltfFile& file, const GltfValue& primitive, std::size_t set) {
    const std::string name = fmt::format("TEXCOORD_{}", set);
    GltfArray<float> floats;
    if (const std::optional<GltfValue> draco = draco_of(primitive); draco && (*draco)["attributes"].has(name.c_str())) {
        DracoMesh decoded = decode_draco(file, *draco);
        floats = take_attribute(decoded, *draco, name, 2, 2);
    } else {
        floats = floats_of(file, primitive, name, 2, 2);
    }
    std::vector<Vec2> uvs;
    uvs.reserve(floats.size() / 2);
    floats.for_each_block([&](std::span<const float> block) {
        for (std::size_t i = 0; i < block.size(); i += 2)
            uvs.push_back(as_uv(block.data() + i));
    });
    return uvs;
}

}
