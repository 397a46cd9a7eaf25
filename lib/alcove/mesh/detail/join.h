/// Joins vertices that an exporter's rounding has moved apart.
#pragma once

#include "alcove/mesh/mesh.h"

namespace alcove {

struct JoinedMesh {
    Mesh mesh;                            ///< of the same faces; without `source` and `attributes`
    std::vector<std::uint32_t> vertex_of; ///< for each vertex of the original, its vertex in `mesh`
};

/// Joins vertices within a finite length, not in voxels: each moves to the position of the first of them. In a mesh
/// without normals they become one vertex, in the order of the first ones. In a mesh with normals they stay separate at
/// that position, as their normals may differ. Warns of faces that lose corners. \throw InputError for a length that
/// makes no sense with the mesh, or that joins the corners of every face.
JoinedMesh join_vertices(const Mesh& mesh, const Length& within);

}
