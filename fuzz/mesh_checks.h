/// Invariants of every mesh that was read, and of its triangles and surfels.
#pragma once

#include "alcove/mesh/mesh.h"

namespace alcove::fuzz {

/// Checks that array sizes agree, that indices are in range, that a warning counts the vertices that are not finite,
/// and that triangles and surfels use only finite vertices.
void check_mesh(const Mesh& mesh);

}
