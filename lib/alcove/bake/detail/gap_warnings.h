/// Warnings about faces that touch without sharing vertices.
#pragma once

#include "alcove/mesh/mesh.h"

#include <string>
#include <vector>

namespace alcove {

/// `surfels` are the vertices of the mesh. With `own_normals`, their normals come from the file, so vertices that share
/// a position do no harm. \return warnings, of one line each, that name a defect and its fix.
std::vector<std::string> gap_warnings(const Mesh& mesh, std::span<const Triangle> triangles,
                                      std::span<const Surfel> surfels, bool own_normals);

}
