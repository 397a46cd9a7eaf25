#include "alcove/mesh/formats/gltf/gltf_textures.h"

#include "alcove/mesh/formats/gltf/gltf_values.h"

#include <algorithm>
#include <optional>

namespace alcove {
namespace {

constexpr const char *pbr = "pbrMetallicRoughness", *metallic_roughness = "metallicRoughnessTexture";

/// Appends a texture and its image. `texture` and `image` hold their properties, except the image data. \return the
/// index of the texture in `textures`.
std::size_t append(GltfOutput& output, const GltfTexture& added, Json texture, Json image) {
    add_comments(image, {&added.comment, added.comment.empty() ? 0u : 1u});
    texture["source"] = output.add_png(added.png, std::move(image));
    output.json()["textures"].push_back(std::move(texture));
    return output.json()["textures"].size() - 1;
}

std::size_t append(GltfOutput& output, const GltfTexture& added) {
    return append(output, added, Json::object(), {{"name", "occlusion"}});
}

Json reference(std::size_t texture, int uv_set) {
    Json reference = {{"index", texture}};
    if (uv_set > 0)
        reference["texCoord"] = uv_set;
    return reference;
}

/// Appends a material. \return its index.
std::size_t add_material(Json& json, Json material = Json::object()) {
    json["materials"].push_back(std::move(material));
    return json["materials"].size() - 1;
}

/// The number of primitives of the file that have this material, or that have none if `material` is empty.
std::size_t count_uses(const GltfValue& root, const std::optional<std::size_t>& material) {
    std::size_t uses = 0;
    const GltfValue meshes = root["meshes"];
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        const GltfValue primitives = meshes[m]["primitives"];
        for (std::size_t p = 0; p < primitives.size(); ++p)
            uses +=
                primitives[p].has("material") ? material && primitives[p]["material"].count() == *material : !material;
    }
    return uses;
}

/// Whether a number occurs anywhere in the JSON.
bool has_number(const Json& json, std::size_t number) {
    if (!json.is_structured())
        return json == number;
    return std::any_of(json.begin(), json.end(), [&](const Json& element) { return has_number(element, number); });
}

/// Whether nothing else uses a texture and its image, so that the image can be replaced. `uses` is the number of
/// references to the texture that do not count as other uses.
bool is_replaceable(const Json& json, std::size_t number, std::size_t uses) {
    const Json& texture = json["textures"].at(number);
    if (!texture.contains("source") || texture.contains("extensions")) // an extension may name another image
        return false;
    // Extensions of the file may refer to textures and images by other keys.
    const auto is_used_by_extensions = [&](std::size_t index) {
        return json.contains("extensions") && has_number(json["extensions"], index);
    };
    const auto image = texture["source"].get<std::size_t>();
    return count_values(json, "index", number) == uses && count_values(json, "source", image) == 1 &&
           !is_used_by_extensions(number) && !is_used_by_extensions(image);
}

/// Whether the program that made `added` also made the image of a texture.
bool is_made_by_same(const Json& json, std::size_t number, const GltfTexture& added) {
    const std::string program = added.comment.substr(0, added.comment.find(' ') + 1);
    const Json& texture = json["textures"].at(number);
    if (program.empty() || !texture.contains("source"))
        return false;
    const Json& image = json["images"].at(texture["source"].get<std::size_t>());
    const auto comments = Json::json_pointer("/extras/comments");
    return image.contains(comments) && image[comments].is_array() &&
           std::any_of(image[comments].begin(), image[comments].end(), [&](const Json& line) {
               return line.is_string() && line.get_ref<const std::string&>().starts_with(program);
           });
}

void replace(GltfOutput& output, const GltfTexture& added, std::size_t number) {
    const auto image = output.json()["textures"][number]["source"].get<std::size_t>();
    output.replace_png(image, added.png);
    add_comments(output.json()["images"][image], {&added.comment, added.comment.empty() ? 0u : 1u});
}

/// Stores a texture that also replaces the metallic-roughness texture of the material. \return the index of the
/// texture.
std::size_t add_packed(GltfOutput& output, const GltfTexture& added, std::size_t material) {
    Json& json = output.json();
    const Json& own = json["materials"][material];
    const auto number = own[pbr][metallic_roughness]["index"].get<std::size_t>();
    const bool shows_both = own.contains("occlusionTexture") && own["occlusionTexture"]["index"] == number;
    if (is_replaceable(json, number, shows_both ? 2 : 1)) {
        replace(output, added, number);
        return number;
    }
    Json texture = json["textures"].at(number);
    Json image = json["images"].at(texture.at("source").get<std::size_t>());
    texture.erase("extensions");
    const std::size_t made = append(output, added, std::move(texture), std::move(image));
    json["materials"][material][pbr][metallic_roughness]["index"] = made;
    return made;
}

/// Stores a texture that is only the occlusion texture of the material. \return the index of the texture.
std::size_t add_own(GltfOutput& output, const GltfTexture& added, std::size_t material) {
    const Json& json = output.json();
    if (json["materials"][material].contains("occlusionTexture")) {
        const auto number = json["materials"][material]["occlusionTexture"].at("index").get<std::size_t>();
        if (is_made_by_same(json, number, added) && is_replaceable(json, number, 1)) {
            replace(output, added, number);
            return number;
        }
    }
    return append(output, added);
}

}

std::vector<std::string> add_textures(GltfOutput& output, const GltfValue& root,
                                      std::span<const GltfTexture> textures) {
    Json& json = output.json();
    std::vector<std::string> messages;
    for (const GltfTexture& added : textures) {
        std::size_t material = added.material.value_or(0);
        if (!added.material || count_uses(root, added.material) > added.primitives.size()) {
            material = add_material(json, added.material ? Json(json["materials"][*added.material]) : Json::object());
            for (const auto& [mesh, primitive] : added.primitives)
                json["meshes"][mesh]["primitives"][primitive]["material"] = material;
        }
        if (const auto& own = json["materials"][material];
            own.contains("occlusionTexture") &&
            !is_made_by_same(json, own["occlusionTexture"].at("index").get<std::size_t>(), added))
            messages.emplace_back("the occlusion texture of the input is replaced");
        const std::size_t number =
            added.is_packed ? add_packed(output, added, material) : add_own(output, added, material);
        json["materials"][material]["occlusionTexture"] = reference(number, added.uv_set);
    }
    return messages;
}

void add_texture_to_all(GltfOutput& output, const GltfTexture& texture) {
    Json& json = output.json();
    const std::size_t number = append(output, texture);
    if (!json.contains("materials")) {
        const std::size_t material = add_material(json);
        for (Json& primitive : json["meshes"][0]["primitives"])
            primitive["material"] = material;
    }
    for (Json& material : json["materials"])
        material["occlusionTexture"] = reference(number, texture.uv_set);
}

}
