/// Invariants of every stack of grids, read or voxelized.
#pragma once

#include "alcove/grid/grid_stack.h"

namespace alcove::fuzz {

/// Checks that the stack has levels, that their voxels and bands are finite and positive, that all values are finite,
/// and that warnings are well-formed.
void check_grids(const GridStack& stack);

}
