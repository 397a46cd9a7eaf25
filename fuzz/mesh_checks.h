/// What holds of every mesh that was read, and of what is built on it.
#pragma once

#include "alcove/mesh/mesh.h"

namespace alcove::fuzz {

/// Sizes that agree, indices in range, vertices that are finite or counted in a warning; triangles and surfels of finite
/// vertices only.
void check_mesh(const Mesh& mesh);

}
