/// Normals that are smooth on a surface and discontinuous at its sharp edges.
#pragma once

#include "alcove/mesh/mesh.h"
#include "alcove/mesh/normals.h"

#include <array>

namespace alcove {

/// One normal per corner of the triangles of triangulate(mesh), unit length; zero if all faces around the vertex are
/// degenerate. It is the normal that the file has for the corner or vertex, if there is one. Otherwise it is the
/// area-weighted mean of the normals of those triangles at the vertex whose normals are within 40 degrees of the
/// triangle's own. At vertices of more than 256 triangles, it is the normal of the triangle. All vertices of the
/// triangles must be finite, as triangulate() ensures. Cost: linear in the triangles, times the number of triangles
/// around a vertex.
std::vector<std::array<Vec3, 3>> corner_normals(const Mesh& mesh, std::span<const Triangle> triangles);

/// The corner normals from a chosen source. For `automatic` and `file`, they are as above. For `angle` and `area`, all
/// corners at a vertex have the same normal. \throw InputError if `source` is `file` and the mesh has no normals.
std::vector<std::array<Vec3, 3>> corner_normals(const Mesh& mesh, std::span<const Triangle> triangles,
                                                NormalSource source);

}
