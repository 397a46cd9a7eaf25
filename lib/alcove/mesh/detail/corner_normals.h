/// Normals that are smooth on a surface and discontinuous at its edges.
#pragma once

#include "alcove/mesh/mesh.h"
#include "alcove/mesh/normals.h"

#include <array>

namespace alcove {

/// One normal per corner of the triangles of triangulate(mesh), unit length; zero if all faces around the vertex are
/// degenerate. It is the normal of the corner or vertex in the file, if there is one. Otherwise it is the area-weighted
/// mean of the normals of the adjacent faces, but only of those within 40 degrees of the normal of the triangle. At
/// vertices of more than 256 faces, it is the normal of the triangle. All vertices of the triangles must be finite, as
/// triangulate() ensures. Cost: linear in the triangles, times the number of triangles around a vertex.
std::vector<std::array<Vec3, 3>> corner_normals(const Mesh& mesh, std::span<const Triangle> triangles);

/// The corner normals for a given source. For `automatic` and `file`, they are as above. For `angle` and `area`, all
/// corners at a vertex have the same normal. \throw InputError if `source` is `file` and the mesh has no normals.
std::vector<std::array<Vec3, 3>> corner_normals(const Mesh& mesh, std::span<const Triangle> triangles,
                                                NormalSource source);

}
