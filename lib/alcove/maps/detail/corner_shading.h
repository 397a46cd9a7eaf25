/// The normals with which maps shade a mesh.
#pragma once

#include "alcove/mesh/mesh.h"
#include "alcove/mesh/normals.h"

#include <array>
#include <span>
#include <vector>

namespace alcove {

/// One normal per corner of the triangles of triangulate(mesh). `automatic` and `file`: see corner_normals(), with hard
/// edges; `angle` and `area`: one per vertex. \throw InputError if `source` is `file` and the mesh has no normals.
std::vector<std::array<Vec3, 3>> shading_normals(const Mesh& mesh, std::span<const Triangle> triangles,
                                                 NormalSource source);

}
