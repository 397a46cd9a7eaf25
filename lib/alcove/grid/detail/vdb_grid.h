/// The only header that includes OpenVDB, which takes a quarter of a minute to compile: include it in few .cpp files
/// and in no public header.
#pragma once

#include "alcove/grid/grid_stack.h"

#include <openvdb/openvdb.h>

namespace alcove {

struct VdbGrid {
    openvdb::FloatGrid::Ptr grid;
};

/// Multiplies every value and the background by `factor`; exact if that is a power of two.
void scale_values(openvdb::FloatGrid& grid, double factor);

}
