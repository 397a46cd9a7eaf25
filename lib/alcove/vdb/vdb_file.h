/// Level sets in .vdb files: ours out and in again, those of any other program in.
#pragma once

#include "alcove/grid/grid_stack.h"

#include <filesystem>

namespace alcove {

/// Writes the levels as float grids `surface`, `surface_2`, ... of class level set, Blosc-compressed, with
/// `creator` and `alcove:*` metadata, to a temporary file renamed over `file`. Values and transforms are in
/// scene units. `alcove:checksum` is the CRC-32 of all that read_grids() takes from the grid, whatever the compression.
/// \throw IoError if it cannot be written.
void write_grids(const GridStack& stack, const std::filesystem::path& file);

/// Reads a stack that write_grids() wrote, to the same bits; from any other file the first float grid of
/// class level set (or, without one, the first float grid with a background above 0) as a single level
/// in the frame of its active voxels, whatever its transform as long as its voxels are cubes along the axes.
///
/// Damage of a stack with checksums is found, but for one time in 2³². A file of another program is refused where
/// lengths, masks, places or counts contradict each other, zipped values do not unpack, values are not finite or are
/// larger than the grid is wide; where values are no distances beside those of their neighbours,
/// `GridStack::warnings` counts them. What such a file says but once is not checked: where the grid lies, and values
/// that are off by less than about a voxel. The same holds of a stack written before there were checksums, and of the
/// values of solids alone. Grids of other types than float are passed over. Thread-safe; by threads of parallel_for.
/// Cost: beside that of OpenVDB, the file is read once before, and its zipped values are unpacked.
///
/// \throw InputError naming what is wrong: no .vdb file, damaged, changed since it was written, no level set in it,
/// voxels that are no cubes, a file that cannot be opened.
GridStack read_grids(const std::filesystem::path& file);

}
