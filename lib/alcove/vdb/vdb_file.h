/// Writes and reads level sets in .vdb files; also reads those of other programs.
#pragma once

#include "alcove/grid/grid_stack.h"

#include <filesystem>

namespace alcove {

/// Writes the levels as float grids `surface`, `surface_2`, ... of class level set, Blosc-compressed, with
/// `creator` and `alcove:*` metadata, to a temporary file that is renamed to `file`. Values and transforms are in
/// scene units. `alcove:checksum` is the CRC-32 of everything that read_grids() uses, independent of the compression.
/// \throw IoError if the file cannot be written.
void write_grids(const GridStack& stack, const std::filesystem::path& file);

/// Reads a stack that write_grids() wrote, bit for bit. From any other file, reads the first float grid of class
/// level set (or else the first float grid with a background above 0) as a single level in the frame of its active
/// voxels. Its transform may be any whose voxels are axis-aligned cubes.
///
/// In a stack with checksums, damage is detected except with a probability of 2⁻³². A file of another program is
/// refused if its lengths, masks, offsets or counts are inconsistent, zipped values do not unpack, or values are
/// not finite or larger than the grid is wide. `GridStack::warnings` counts values that are not distances because
/// they differ too much from their neighbours. Errors in data that such a file stores only once cannot be detected:
/// a wrong translation of the grid, and values that are wrong by less than about a voxel. A stack that alcove wrote
/// before there were checksums gets the same checks, except that the values are compared with their neighbours only
/// for solids. Ignores grids of types other than float. Thread-safe; uses the threads of parallel_for. Cost: in
/// addition to OpenVDB's, reads the file once beforehand and unpacks its zipped values.
///
/// \throw InputError with the reason: not a .vdb file, damaged, changed since it was written, no level set in it,
/// voxels that are not cubes, or the file cannot be opened.
GridStack read_grids(const std::filesystem::path& file);

}
