/// Checks level sets of other programs.
#pragma once

#include "alcove/grid/grid_stack.h"

#include <filesystem>
#include <string>
#include <vector>

namespace alcove {

/// The width of the inner band, in the unit of the values. The inner band ends at the value that fills the inside; if
/// no value fills it, the inner band is as wide as the outer band.
float inner_band_of(const VdbGrid& grid);

/// The centre of the voxel of index (0, 0, 0), scene units.
Vec3d origin_of(const VdbGrid& grid);

/// The point with each coordinate rounded to a float.
Vec3d rounded_to_floats(const Vec3d& p);

/// Warns of values that cannot be distances; refuses the file if a value is larger than the extent of the grid.
void check_outliers(const VdbGrid& grid, const std::filesystem::path& file, std::vector<std::string>& warnings);

/// Checks a level set that another program wrote, fills its inside, and converts distances in other units, such as
/// voxels, to scene units. \return why the level set is useless; empty if it is useful. \throw InputError if the level
/// set is damaged, or if no voxels around its surface hold distances.
std::string prepare(const VdbGrid& grid, const std::filesystem::path& file, std::vector<std::string>& warnings);

}
