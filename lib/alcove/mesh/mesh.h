/// A polygon mesh as an indexed face set: the contents of a file, in the order of the file, and values that were added.
#pragma once

#include "alcove/base/types.h"

#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alcove {

class SourceDocument; // the rest of the file's contents, kept to be written back (mesh/detail/source.h)

/// Values added to the vertices: `components` floats per vertex, in vertex order.
struct Attribute {
    std::string name;
    int components = 1;
    std::vector<float> values;
};

enum class ColorEncoding {
    srgb, ///< bytes that decode to the value as sRGB (IEC 61966-2-1, 1999), which viewers and Blender assume
    raw,  ///< 255 × value
};

/// Consecutive faces with the same names in the file. In a glTF, these are the names of the node, its ancestors, its
/// mesh and its material; in an OBJ, the names in the `o`, `g` and `usemtl` lines.
struct FaceGroup {
    static constexpr std::size_t most_letters = 256; ///< of a name; longer names are truncated

    std::vector<std::string> names;
    std::uint32_t first_face = 0; ///< the group ends where the next one begins
    bool see_through = false;     ///< the group's glTF material is masked or blended
};

/// Vertices and faces keep the count and order of the file, even if they are invalid: non-finite vertices, faces of
/// fewer than three corners and coincident vertices are kept. Functions that need valid geometry work on the result of
/// triangulate(), which leaves out invalid faces and counts them.
struct Mesh {
    std::vector<Vec3d> positions;             ///< scene units
    std::vector<Vec3> normals;                ///< empty, or one per vertex: those of the file, unit length or zero
    std::vector<Vec3> corner_normals;         ///< empty, or one per corner if vertices have several in the file
    std::vector<std::uint32_t> face_begin{0}; ///< faces + 1 offsets into `corners`
    std::vector<std::uint32_t> corners;       ///< vertex indices of one face after another; all in range
    std::vector<Vec2> vertex_uvs;             ///< empty, or one per vertex
    std::vector<Vec2> corner_uvs;             ///< empty, or one per corner; never together with vertex_uvs
    std::vector<Color> vertex_colors;         ///< empty, or one per vertex: those of the file
    std::vector<Color> face_colors;           ///< empty, or one per face: those of the file
    std::vector<FaceGroup> groups;            ///< empty, or groups that cover all faces, in face order
    std::vector<Attribute> attributes;        ///< added values, written in addition to those from the file
    std::vector<std::string> warnings;        ///< messages about data that could not be read, with counts
    std::vector<Color> added_colors;          ///< empty, or one per vertex, to replace those of the file
    ColorEncoding added_encoding = ColorEncoding::srgb; ///< of added_colors
    /// Empty, or one flag per vertex: 1 if added values are written for the vertex. Nodes of a glTF scene that have no
    /// such vertex stay unchanged.
    std::vector<std::uint8_t> baked_vertices;
    /// Instances of one mesh in a glTF scene share one set of added values if their values differ by an RMSE of at most
    /// this.
    double instance_error = 0.0;
    std::vector<std::string> added_comments;      ///< provenance lines to write; the first word names the program
    std::string name;                             ///< the file that the mesh was read from, for messages; may be empty
    std::string_view format;                      ///< "PLY", "OBJ", "OFF", "STL", "glTF"; empty if not from a file
    std::shared_ptr<const SourceDocument> source; ///< null for a mesh that was not read from a file

    std::size_t vertex_count() const { return positions.size(); }
    std::size_t face_count() const { return face_begin.size() - 1; }
    std::span<const std::uint32_t> face(std::size_t f) const {
        return {corners.data() + face_begin[f], corners.data() + face_begin[f + 1]};
    }
    void add_face(std::span<const std::uint32_t> vertices);
    /// One past the last face of a group.
    std::size_t group_end(std::size_t group) const {
        return group + 1 < groups.size() ? groups[group + 1].first_face : face_count();
    }

    /// For each vertex, 1 if a face uses it, else 0. If there are no faces, 1 for all vertices.
    std::vector<std::uint8_t> used_vertices() const;
    /// The bounding box of the finite vertices that faces use, or of all finite vertices if there are no faces.
    Box box() const;

    /// Adds the attribute, or replaces the one of the same name. \throw std::invalid_argument if the name cannot be
    /// that of a PLY property or is x, y, z, nx, ny or nz, or if the number of values is not components × vertices.
    void set_attribute(Attribute attribute);
    const Attribute* find_attribute(std::string_view name) const;
};

inline bool is_finite(const Vec3d& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}
