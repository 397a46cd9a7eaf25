/// Splits a mesh into its connected components.
#pragma once

#include "alcove/mesh/mesh.h"

namespace alcove {

/// One component as a separate mesh.
struct MeshPart {
    Mesh mesh;                           ///< positions, normals and faces; nothing else
    std::vector<std::uint32_t> vertices; ///< for each vertex of the part, its index in the whole mesh
};

/// The components in the order of their first faces; vertices and faces keep the order of the whole mesh.
///
/// As in diagnose(), vertices at exactly the same position are joined, and faces are connected across edges. So parts
/// that touch only at a point are separate, and a vertex of several parts is in each of them. Invalid faces (with fewer
/// than three distinct corners, or with one that is not finite) and vertices that no valid face uses are in no part.
/// Cost: linear, about 0.2 µs per triangle.
std::vector<MeshPart> split_parts(const Mesh& mesh);

}
