/// The vertices and triangles of glTF primitives.
#pragma once

#include "alcove/base/types.h"
#include "alcove/mesh/formats/gltf/gltf_array.h"
#include "alcove/mesh/formats/gltf/gltf_file.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace alcove {

/// Primitives of one mesh that share their vertices. The file must outlive the arrays.
struct GltfPrimitives {
    std::vector<std::size_t> numbers;              ///< indices of these primitives in the mesh
    std::vector<GltfArray<std::uint32_t>> corners; ///< of the triangles of each primitive; all in range
    GltfArray<float> positions, normals, colors;   ///< 3, 3 and color_components floats per vertex
    int color_components = 4;
    GltfArray<float> uvs; ///< as in the file, see as_uv()

    std::size_t count() const { return positions.size() / 3; }
    void keep(); ///< decodes all arrays now and keeps them, for repeated use
};

/// Whether a primitive consists of faces that can be read.
bool is_surface(const GltfValue& primitive);
bool is_draco(const GltfValue& primitive);
std::optional<GltfValue> accessor_of(const GltfValue& root, const GltfValue& primitive, const char* attribute);
/// An upper bound on the number of triangle corners of a primitive. Decodes nothing.
double most_corners(const GltfValue& root, const GltfValue& primitive, std::size_t vertex_count);

/// The vertices of a primitive, and its corners if it is compressed with Draco. \throw like GltfAccessor and
/// decode_draco()
GltfPrimitives vertices_of(GltfFile& file, const GltfValue& primitive);
/// The corners of the triangles of a list, strip or fan that is not compressed with Draco.
GltfArray<std::uint32_t> corners_of(GltfFile& file, const GltfValue& primitive, std::size_t vertex_count);

/// Converts texture coordinates: glTF measures v from the top of the image, Alcove from the bottom.
inline Vec2 as_uv(const float* in_file) {
    return {in_file[0], 1.0f - in_file[1]};
}

}
