#include "alcove/mesh/formats/gltf/gltf_images.h"

#include <fmt/format.h>

namespace alcove {
namespace {

std::optional<GltfValue> metallic_roughness(const GltfFile& file, std::size_t material) {
    const std::optional<GltfValue> pbr = file.root()["materials"][material].find("pbrMetallicRoughness");
    return pbr ? pbr->find("metallicRoughnessTexture") : std::nullopt;
}

}

std::optional<std::size_t> metallic_roughness_uv_set(const GltfFile& file, std::size_t material) {
    const std::optional<GltfValue> reference = metallic_roughness(file, material);
    if (!reference)
        return {};
    const std::optional<GltfValue> extensions = reference->find("extensions");
    if (extensions && extensions->has("KHR_texture_transform"))
        return {};
    return reference->count_or("texCoord", 0);
}

GltfImage metallic_roughness_image(GltfFile& file, std::size_t material) {
    const GltfValue root = file.root();
    const GltfValue texture = (*metallic_roughness(file, material))["index"].target(root, "textures");
    if (!texture.has("source"))
        texture.fail("has no PNG or JPEG image, which --pack-orm needs; convert it, or leave out --pack-orm");
    const GltfValue image = texture["source"].target(root, "images");
    return {fmt::format("{}: {}", file.bytes().path().string(), image.place()), file.image(image).read()};
}

}
