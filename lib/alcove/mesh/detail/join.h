/// Joins vertices that an exporter's rounding has moved apart.
#pragma once

#include "alcove/mesh/mesh.h"

namespace alcove {

struct JoinedMesh {
    Mesh mesh;                            ///< has the same faces, but no `source` or `attributes`
    std::vector<std::uint32_t> vertex_of; ///< for each vertex of the original, its vertex in `mesh`
};

/// Joins vertices that are within a length of each other; the length must be finite and not in voxels. Each vertex
/// moves to the position of its representative, see weld(). In a mesh without normals, joined vertices become one
/// vertex, and representatives keep their order. In a mesh with normals, they stay separate vertices at that position,
/// as their normals may differ. Warns of faces that lose corners. \throw InputError for a length that makes no sense
/// with the mesh, or that joins the corners of every face.
JoinedMesh join_vertices(const Mesh& mesh, const Length& within);

}
