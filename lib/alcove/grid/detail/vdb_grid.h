/// The only header that includes OpenVDB, which takes a quarter of a minute to compile: include it in few .cpp files
/// and in no public header.
#pragma once

#include "alcove/grid/grid_stack.h"
#include "alcove/mesh/mesh.h"

#include <openvdb/openvdb.h>

namespace alcove {

struct VdbGrid {
    openvdb::FloatGrid::Ptr grid;
};

/// The zero isosurface of a grid, positioned by its transform and oriented outward. \throw InputError if no sign
/// changes.
Mesh mesh_zero_surface(const VdbGrid& grid);

/// Multiplies every value and the background by `factor`; exact if that is a power of two.
void scale_values(openvdb::FloatGrid& grid, double factor);

}
