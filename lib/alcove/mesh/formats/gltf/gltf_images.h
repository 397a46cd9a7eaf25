/// The images of a glTF file, before they are decoded.
#pragma once

#include "alcove/mesh/formats/gltf/gltf_file.h"

#include <optional>
#include <string>

namespace alcove {

struct GltfImage {
    std::string name; ///< "scene.glb: images[3]", for messages
    std::string bytes;
};

/// The UV set that a material uses for its metallic-roughness texture; empty if it has no such texture, or if
/// KHR_texture_transform moves the texture.
std::optional<std::size_t> metallic_roughness_uv_set(const GltfFile& file, std::size_t material);

/// The image of the metallic-roughness texture of a material. \throw InputError if the image is missing, or exists only
/// in a format that a glTF extension defines.
GltfImage metallic_roughness_image(GltfFile& file, std::size_t material);

}
