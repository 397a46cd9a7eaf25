/// Writes and reads level sets in .vdb files; also reads those of other programs.
#pragma once

#include "alcove/grid/grid_stack.h"
#include "alcove/grid/voxelize.h"

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace alcove {

/// Writes the levels as float grids `surface`, `surface_2`, ..., and the partial levels as `surface_fine_1` (with half
/// the voxel size of `surface`), `surface_fine_2`, ... The grids are of class level set, Blosc-compressed, and have
/// `creator` and `alcove:*` metadata. Writes to a temporary file that is renamed to `file`. Values and transforms are
/// in scene units. `alcove:checksum` is the CRC-32 of everything that read_grids() uses, independent of the
/// compression.
/// \throw IoError if the file cannot be written.
void write_grids(const GridStack& stack, const std::filesystem::path& file);

/// A grid in a .vdb file.
struct StoredGrid {
    std::string name;                          ///< unique: grids of the same name are "surface[0]", "surface[1]", ...
    std::string type;                          ///< of its values: "float", "double", "vec3s", ...
    std::string grid_class;                    ///< "level set", "fog volume", "staggered" or "unknown"
    std::optional<std::int64_t> active_voxels; ///< if the file gives the number
};

/// All grids in the order of the file. \throw InputError like read_grids(), but a file without level sets is refused
/// only if it is damaged.
std::vector<StoredGrid> list_grids(const std::filesystem::path& file);

/// Which grids of a file to read.
struct GridSelection {
    std::vector<std::string> names{}; ///< empty: all level sets
    /// Limit of the memory for the grids, bytes; at most the memory limit of the process.
    double memory_limit = std::numeric_limits<double>::infinity();
};

/// Reads back, bit for bit, a stack that write_grids() wrote. From any other file, reads all float and double level
/// sets, or, if there are none, all float and double grids that hold distances but have no grid class. Their union
/// becomes a single level, in the frame of the union's active voxels. Several stacks, or a stack and other level sets,
/// are also read as one union, with the finest level of each stack.
///
/// All transforms except frustums are supported. Level sets that share a lattice keep their values, even if they are
/// rotated by 90° or mirrored. Other level sets are interpolated on the lattice of the smallest voxels, which rounds
/// sharp edges by a fraction of a voxel; where voxels are not cubes, the zero isosurface is voxelized again. See
/// detail/join.h.
///
/// In a stack with checksums, damage is missed only with a probability of 2⁻³². A file written by another program is
/// refused if its lengths, masks, offsets or counts are inconsistent, if compressed values cannot be unpacked, or if a
/// value is infinite, NaN, or larger than the extent of the grid. `GridStack::warnings` counts values that cannot be
/// distances, because they differ too much from their neighbours. Errors in data that such a file stores only once
/// cannot be detected: a wrong translation of the grid, and values that are wrong by less than about a voxel. A stack
/// from a version of Alcove that wrote no checksums gets the same checks, except that values are compared with their
/// neighbours only in solids. Thread-safe; uses the threads of parallel_for. Cost: OpenVDB's own, plus reading the file
/// once beforehand and unpacking its compressed values.
///
/// \throw InputError, giving the reason: the file cannot be opened, is not a .vdb file, is damaged, has changed since
/// it was written, contains no level set, or has a surface around which no voxels hold distances. LimitError if the
/// grids exceed the memory limit.
GridStack read_grids(const std::filesystem::path& file, const GridSelection& selection = {});

/// The lattice of the voxels of the finest level set. \throw like read_grids(), and InputError if these voxels are not
/// cubes along the axes.
Lattice read_lattice(const std::filesystem::path& file);

}
