#include "alcove/mesh/formats/gltf/gltf_document.h"

#include "alcove/mesh/formats/formats.h"
#include "alcove/mesh/formats/text_encoding.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace alcove {

bool GltfDocument::has_vertex_property(std::string_view name) const {
    if (name != "red" && name != "green" && name != "blue")
        return false;
    const GltfValue root = file->root();
    return std::any_of(vertices.begin(), vertices.end(), [&](const GltfVertices& block) {
        const GltfValue mesh = root["meshes"][placements[block.placement].mesh];
        return mesh["primitives"][block.primitives.front()]["attributes"].has("COLOR_0");
    });
}

std::string_view GltfDocument::comment(std::string_view beginning) const {
    const std::optional<GltfValue> extras = file->root()["asset"].find("extras");
    const std::optional<GltfValue> comments = extras ? extras->find("comments") : std::nullopt;
    for (std::size_t i = 0; comments && comments->json().is_array() && i < comments->size(); ++i)
        if (const GltfValue line = (*comments)[i]; line.json().is_string() && line.text().starts_with(beginning))
            return line.text();
    return {};
}

std::vector<Vec2> GltfDocument::uv_set(std::size_t number) const {
    std::vector<Vec2> uvs(vertex_count(), Vec2(0.0f));
    std::map<std::pair<std::size_t, std::size_t>, std::vector<Vec2>> known; // by mesh and primitive
    for (const GltfVertices& block : vertices) {
        const std::size_t mesh = placements[block.placement].mesh, primitive = block.primitives.front();
        const auto [found, is_new] = known.try_emplace({mesh, primitive});
        if (is_new)
            found->second = uvs_of_primitive(*file, file->root()["meshes"][mesh]["primitives"][primitive], number);
        const std::vector<Vec2>& own = found->second;
        std::copy(own.begin(), own.end(), uvs.begin() + static_cast<std::ptrdiff_t>(block.first));
    }
    return uvs;
}

bool begins_as_gltf(const FileBytes& file) {
    if (file.view().starts_with("glTF"))
        return true;
    const std::string_view text = without_byte_order_mark(file.view());
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    return first != std::string_view::npos && text[first] == '{';
}

}
