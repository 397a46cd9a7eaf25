#include "grid_checks.h"

#include "alcove/grid/detail/vdb_grid.h"
#include "alcove/mesh/mesh.h"
#include "checks.h"

#include <cmath>

namespace alcove::fuzz {
namespace {

bool is_positive(double value) {
    return std::isfinite(value) && value > 0.0;
}

void check_level(const LevelSet& level) {
    require(is_positive(level.voxel), "voxels are finite and above 0");
    require(is_positive(double(level.outer_band)) && is_positive(double(level.inner_band)),
            "bands are finite and above 0");
    require(is_finite(Vec3d(level.origin)), "origins are finite");
    const openvdb::FloatGrid& grid = *level.grid->grid;
    require(is_positive(grid.background()), "the background is outside");
    require(level.active_voxels == grid.activeVoxelCount(), "active voxels are counted");
    for (auto value = grid.cbeginValueAll(); value; ++value)
        require(std::isfinite(*value), "values are finite");
}

}

void check_grids(const GridStack& stack) {
    require(!stack.levels.empty(), "there are levels");
    require(is_positive(stack.frame.diagonal) && is_positive(stack.value_unit) && is_finite(stack.frame.center),
            "the frame is finite");
    for (const LevelSet& level : stack.levels)
        check_level(level);
    for (const std::string& warning : stack.warnings)
        check_message(warning, "");
}

}
