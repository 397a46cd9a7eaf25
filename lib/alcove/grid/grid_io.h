/// Level sets in .vdb files: ours out and in again, those of any other program in.
#pragma once

#include "alcove/grid/grid_stack.h"

#include <filesystem>

namespace alcove {

/// Writes the levels as float grids `surface`, `surface_2`, ... of class level set, Blosc-compressed, with
/// `creator` and `alcove:*` metadata, to a temporary file renamed over `file`. Values and transforms are in
/// scene units. \throw IoError if it cannot be written.
void write_grids(const GridStack& stack, const std::filesystem::path& file);

/// Reads a stack that write_grids() wrote, to the same bits; from any other file the first float grid of
/// class level set (or, without one, the first float grid with a background above 0) as a single level
/// in the frame of its active voxels, whatever its transform as long as its voxels are cubes along the axes.
///
/// Every value is checked: OpenVDB reads a truncated file as if it were whole.
/// \throw InputError naming what is wrong: no .vdb file, damaged, no level set in it, voxels that are no
/// cubes, values that are not finite, a file that cannot be opened.
GridStack read_grids(const std::filesystem::path& file);

}
