/// The images of a glTF file, not decoded.
#pragma once

#include "alcove/mesh/formats/gltf/gltf_file.h"

#include <optional>
#include <string>

namespace alcove {

struct GltfImage {
    std::string name; ///< "scene.glb: images[3]", for messages
    std::string bytes;
};

/// The set of UVs that a material uses for its metallic-roughness texture; empty if there is none, or if
/// KHR_texture_transform moves it.
std::optional<std::size_t> metallic_roughness_uv_set(const GltfFile& file, std::size_t material);

/// The image of the metallic-roughness texture of a material. \throw InputError if the image is missing, or exists only
/// in a format that a glTF extension defines.
GltfImage metallic_roughness_image(GltfFile& file, std::size_t material);

}
