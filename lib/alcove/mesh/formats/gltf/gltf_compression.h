/// Compressed data in glTF files: EXT_meshopt_compression (Kapoulkine 2020) and KHR_draco_mesh_compression (Khronos
/// 2018).
#pragma once

#include "alcove/mesh/formats/gltf/gltf_file.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alcove {

/// The part of `bytes` that the byteOffset and byteLength of an object describe.
FilePart range_in(const FilePart& bytes, const GltfValue& object);

/// The EXT_meshopt_compression object of an element of `bufferViews`, if it has one.
std::optional<GltfValue> meshopt_of(const GltfValue& view);
/// \throw InputError if the data is damaged, LimitError if it would exceed the memory limit.
std::string decompress(GltfFile& file, const GltfValue& meshopt);

/// A primitive decoded from Draco.
struct DracoMesh {
    std::size_t vertices = 0;
    std::vector<std::uint32_t> indices; ///< of triangles
    struct Values {
        int components = 0;
        std::vector<float> floats; ///< normalized integers as numbers in [0, 1] or [-1, 1]
    };
    std::map<std::string, Values> attributes; ///< by name: "POSITION"
};
/// `draco`: the extension object of a primitive. \throw like decompress()
DracoMesh decode_draco(GltfFile& file, const GltfValue& draco);

}
