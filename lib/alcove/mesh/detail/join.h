/// Joins vertices that rounding in an exporter has moved apart.
#pragma once

#include "alcove/mesh/mesh.h"

namespace alcove {

struct JoinedMesh {
    Mesh mesh;                            ///< has the same faces, but no `source` or `attributes`
    std::vector<std::uint32_t> vertex_of; ///< for each vertex of the original, its vertex in `mesh`
};

/// Joins vertices whose distance is at most `within`, which must be finite and not in voxels. Each vertex moves to the
/// position of its representative; see weld(). In a mesh without normals, joined vertices become one vertex, and
/// representatives keep their order. In a mesh with normals, joined vertices stay separate at the same position,
/// because their normals may differ. Warns of faces that lose corners. \throw InputError if the length is out of range
/// for the mesh, or joins the corners of every face.
JoinedMesh join_vertices(const Mesh& mesh, const Length& within);

}
