/// What holds of every stack of grids, read or made.
#pragma once

#include "alcove/grid/grid_stack.h"

namespace alcove::fuzz {

/// Levels of finite, positive voxels, each value of them finite.
void check_grids(const GridStack& stack);

}
