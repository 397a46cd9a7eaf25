/// The vertices and triangles of glTF primitives.
#pragma once

#include "alcove/base/types.h"
#include "alcove/mesh/formats/gltf/gltf_array.h"
#include "alcove/mesh/formats/gltf/gltf_file.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace alcove {

/// Primitives of one mesh that share their vertices. The file must outlive their arrays.
struct GltfPrimitives {
    std::vector<std::size_t> numbers;              ///< of the primitives of the mesh
    std::vector<GltfArray<std::uint32_t>> corners; ///< of the triangles of each; all in range
    GltfArray<float> positions, normals, colors;   ///< three, three, and color_components each
    int color_components = 4;
    GltfArray<float> uvs; ///< as in the file

    std::size_t count() const { return positions.size() / 3; }
    void keep(); ///< decodes all arrays for good, for repeated use
};

/// Whether the faces of a primitive are read.
bool is_surface(const GltfValue& primitive);
bool is_draco(const GltfValue& primitive);
std::optional<GltfValue> accessor_of(const GltfValue& root, const GltfValue& primitive, const char* attribute);
/// An upper bound of the corners of its triangles, without decoding anything.
double most_corners(const GltfValue& root, const GltfValue& primitive, std::size_t vertex_count);

/// The vertices of a primitive, and the corners if it is compressed with Draco. Each throws like GltfAccessor and
/// decode_draco().
GltfPrimitives vertices_of(GltfFile& file, const GltfValue& primitive);
/// The corners of the triangles of a list, strip or fan that is not compressed with Draco.
GltfArray<std::uint32_t> corners_of(GltfFile& file, const GltfValue& primitive, std::size_t vertex_count);

/// glTF counts v from the top of the image, Alcove from the bottom.
inline Vec2 as_uv(const float* in_file) {
    return {in_file[0], 1.0f - in_file[1]};
}

}
