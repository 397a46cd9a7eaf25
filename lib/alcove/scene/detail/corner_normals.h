/// Normals that are smooth within a surface and break at its edges.
#pragma once

#include "alcove/mesh/mesh.h"

#include <array>

namespace alcove {

/// One a corner of each triangle, unit length, or zero where all faces around it are degenerate: the file's normal of the
/// vertex, or where it has none the area-weighted mean of those faces around it that are within 40 degrees of the triangle
/// itself; around a vertex of more than 256, the face's own. Triangles hold finite vertices only (as triangulate() gives).
/// Cost: linear, times the triangles around a vertex.
std::vector<std::array<Vec3, 3>> corner_normals(const Mesh& mesh, std::span<const Triangle> triangles);

}
