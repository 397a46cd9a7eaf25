/// Writes glTF files with occlusion textures.
#pragma once

#include "alcove/mesh/mesh.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace alcove {

struct GltfTexture {
    std::optional<std::size_t> material; ///< index in the input file; empty: the primitives have none
    /// The primitives that show the texture: the index of a mesh in the input file, and of a primitive in that mesh.
    std::vector<std::pair<std::size_t, std::size_t>> primitives;
    int uv_set = 0;
    std::string png;        ///< the bytes of the image
    std::string comment{};  ///< how the image was made; the first word names the program
    bool is_packed = false; ///< the image also replaces the metallic-roughness texture of the material
};

/// Writes a .glb or .gltf like write_mesh(), with textures. Textures from an earlier run of the program, and
/// metallic-roughness textures that are replaced, are removed if nothing else uses them. If the mesh does not come from
/// glTF, its only texture is added to all materials.
std::vector<std::string> write_gltf(const Mesh& mesh, const std::filesystem::path& file,
                                    std::span<const GltfTexture> textures);

}
