/// A polygon mesh as an indexed soup: what its file held, in the file's order, and the values added to it.
#pragma once

#include "alcove/base/types.h"

#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alcove {

class SourceDocument; // what the file held beyond the mesh itself, kept to be written back (mesh/source.h)

/// Values added to the vertices: `components` floats a vertex, in vertex order.
struct Attribute {
    std::string name;
    int components = 1;
    std::vector<float> values;
};

/// Vertices and faces keep the count and order of the file, whatever is wrong with them: non-finite vertices
/// stay in place, faces of fewer than three corners stay polygons, coincident vertices stay apart. Stages
/// that need sound geometry (triangulate, vertex_normals, voxelize) leave the rest out and count it.
struct Mesh {
    std::vector<Vec3d> positions;                 ///< scene units
    std::vector<Vec3> normals;                    ///< empty, or one a vertex: the file's, unit length or zero
    std::vector<std::uint32_t> face_begin{0};     ///< faces + 1 offsets into `corners`
    std::vector<std::uint32_t> corners;           ///< vertex indices, face after face; all in range
    std::vector<Vec2> vertex_uvs;                 ///< empty, or one a vertex
    std::vector<Vec2> corner_uvs;                 ///< empty, or one a corner; never beside vertex_uvs
    std::vector<Color> vertex_colors;             ///< empty, or one a vertex: the file's
    std::vector<Color> face_colors;               ///< empty, or one a face: the file's
    std::vector<Attribute> attributes;            ///< added values, written beside what the file held
    std::vector<std::string> warnings;            ///< what reading had to leave out, in words with counts
    std::string_view format;                      ///< "PLY", "OBJ", "OFF", "STL"; empty if not from a file
    std::shared_ptr<const SourceDocument> source; ///< null for a mesh that was not read from a file

    std::size_t vertex_count() const { return positions.size(); }
    std::size_t face_count() const { return face_begin.size() - 1; }
    std::span<const std::uint32_t> face(std::size_t f) const {
        return {corners.data() + face_begin[f], corners.data() + face_begin[f + 1]};
    }
    void add_face(std::span<const std::uint32_t> vertices);

    /// The box around all finite vertices.
    Box box() const;

    /// Adds the attribute, or replaces the one of that name. \throw std::invalid_argument if its length is
    /// not components × vertices.
    void set_attribute(Attribute attribute);
    const Attribute* find_attribute(std::string_view name) const;
};

inline bool is_finite(const Vec3d& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}
