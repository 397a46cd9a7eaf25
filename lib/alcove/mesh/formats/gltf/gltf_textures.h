/// Adds occlusion textures to a glTF file.
#pragma once

#include "alcove/mesh/formats/gltf/gltf_output.h"
#include "alcove/mesh/formats/gltf/gltf_write.h"

#include <span>
#include <string>
#include <vector>

namespace alcove {

/// Adds each texture to its material. If other primitives use the material too, the primitives that show the texture
/// get a copy of the material. `root` is the JSON of the input.
/// \return messages about replaced textures.
std::vector<std::string> add_textures(GltfOutput& output, const GltfValue& root, std::span<const GltfTexture> textures);

/// Adds the texture to all materials of the mesh of a new file.
void add_texture_to_all(GltfOutput& output, const GltfTexture& texture);

}
