/// Places level sets of any linear transform on one lattice, and joins them.
#pragma once

#include "alcove/grid/grid_stack.h"

#include <string>
#include <vector>

namespace alcove {

/// Whether the voxels are cubes.
bool has_cubes(const VdbGrid& grid);

/// Whether the voxels are cubes whose edges point along the axes.
bool is_aligned(const VdbGrid& grid);

/// The union of solids whose values are distances in scene units, or whose voxels are not cubes. A single one that
/// is_aligned() is returned as it is. Otherwise the voxels of the result are cubes along the axes, as large as the
/// smallest edge of a voxel. Where one voxel lies on each voxel, as after rotations by 90° and mirroring, values are
/// copied; else they are interpolated. A grid whose voxels are not cubes, or whose band is thinner than the
/// interpolation needs, is voxelized from its zero isosurface, with a warning; values are then distances again.
///
/// \throw InputError if the surface of a grid to be voxelized is open; LimitError if the result would exceed
/// `memory_limit`, in bytes.
VdbGrid join(const std::vector<VdbGrid>& solids, double memory_limit, std::vector<std::string>& warnings);

}
