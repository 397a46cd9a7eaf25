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
    std::optional<std::size_t> material; ///< of the file that the mesh was read from; empty: of primitives without one
    /// The primitives that show it: meshes of the file, and primitives in them.
    std::vector<std::pair<std::size_t, std::size_t>> primitives;
    int uv_set = 0;
    std::string png;        ///< the bytes of the image
    std::string comment{};  ///< how it was made; the first word is the program
    bool is_packed = false; ///< it also replaces the metallic-roughness texture of the material
};

/// As write_mesh() to a .glb or .gltf, with textures. Textures that the program made earlier, and metallic-roughness
/// textures that are replaced, are removed where nothing else uses them. For a mesh that does not come from glTF, the
/// one texture belongs to all materials.
std::vector<std::string> write_gltf(const Mesh& mesh, const std::filesystem::path& file,
                                    std::span<const GltfTexture> textures);

}
