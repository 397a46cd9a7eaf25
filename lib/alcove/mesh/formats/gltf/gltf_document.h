/// The glTF file that a mesh was read from, and where in the file each vertex of the mesh comes from.
#pragma once

#include "alcove/base/types.h"
#include "alcove/mesh/detail/source.h"
#include "alcove/mesh/formats/gltf/gltf_file.h"
#include "alcove/mesh/formats/gltf/gltf_scene.h"

#include <memory>
#include <optional>
#include <vector>

namespace alcove {

/// The vertices of primitives that share their attributes, in one placement. These vertices are consecutive in the
/// mesh.
struct GltfVertices {
    std::size_t placement;
    std::vector<std::size_t> primitives; ///< indices in the mesh of the placement
    std::size_t first, count;
};

class GltfDocument : public SourceDocument {
  public:
    explicit GltfDocument(const FileBytes& bytes) : file(std::make_unique<GltfFile>(bytes)) {}

    bool has_vertex_property(std::string_view name) const override;
    std::string_view comment(std::string_view beginning) const override;
    std::vector<std::string> contents() const override { return content_counts; }
    std::size_t uv_sets() const override { return uv_set_count; }
    std::vector<Vec2> uv_set(std::size_t number) const override;

    std::size_t vertex_count() const { return vertices.empty() ? 0 : vertices.back().first + vertices.back().count; }

    std::unique_ptr<GltfFile> file; ///< its caches change when a const document is used
    std::vector<GltfPlacement> placements;
    std::vector<GltfVertices> vertices; ///< in the order of the mesh
    /// The primitive of each group of the mesh.
    struct Primitive {
        std::size_t placement, primitive; ///< the primitive is an index in the mesh of the placement
        std::optional<std::size_t> material;
    };
    std::vector<Primitive> group_primitives;
    std::size_t uv_set_count = 0;
    std::vector<std::string> content_counts; ///< the result of contents()
};

/// The texture coordinates of the vertices of a primitive, with v upwards; empty if the primitive lacks the set.
std::vector<Vec2> uvs_of_primitive(GltfFile& file, const GltfValue& primitive, std::size_t set);

}
