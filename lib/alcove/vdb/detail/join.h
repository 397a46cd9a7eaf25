/// Transfers level sets that have any linear transforms to one lattice, and unites them.
#pragma once

#include "alcove/grid/grid_stack.h"

#include <string>
#include <vector>

namespace alcove {

/// Whether the voxels are cubes.
bool has_cubes(const VdbGrid& grid);

/// Whether the voxels are cubes whose edges point along the axes.
bool is_aligned(const VdbGrid& grid);

/// The union of solids. The values of a solid must be distances in scene units if its voxels are cubes. A single grid
/// that is_aligned() is returned as it is. Otherwise the voxels of the result are cubes along the axes, with the
/// smallest edge of all voxels. If each voxel of the result coincides with a voxel of a grid, as after rotations by 90°
/// and mirroring, the values of that grid are copied. Otherwise its values are interpolated. A grid whose voxels are
/// not cubes, or whose band is thinner than the interpolation needs, is voxelized from its zero isosurface, with a
/// warning; its values are then distances.
///
/// \throw InputError if the surface of a grid to be voxelized is open; LimitError if the result would exceed
/// `memory_limit`, in bytes.
VdbGrid join(const std::vector<VdbGrid>& solids, double memory_limit, std::vector<std::string>& warnings);

}
