/// The only door to OpenVDB's headers, which take a quarter of a minute to compile: included by few .cpp
/// files and by no public header.
#pragma once

#include "alcove/grid/grid_stack.h"

#include <openvdb/openvdb.h>

namespace alcove {

struct VdbGrid {
    openvdb::FloatGrid::Ptr grid;
};

/// Every value and the background times a power of two.
void scale_values(openvdb::FloatGrid& grid, double factor);

}
