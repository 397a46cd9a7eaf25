/// Level sets as input for verbs that work on meshes.
#pragma once

#include "alcove/grid/grid_stack.h"
#include "alcove/mesh/mesh.h"

#include <string>

namespace alcove::cli {

/// Whether the name of a file ends in .vdb.
bool is_grid(const std::string& file);

/// The zero isosurface of the grids of a file, made by mesh_zero_surface(). \throw InputError with the name of the
/// file.
Mesh surface_of(const GridStack& grids, const std::string& file, float adaptivity = 0.0f);

}
