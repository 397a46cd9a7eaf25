/// Reads grids of a .vdb file through OpenVDB.
#pragma once

#include "alcove/grid/grid_stack.h"
#include "alcove/vdb/detail/structure.h"

#include <filesystem>
#include <string>
#include <vector>

namespace alcove {

/// \throw InputError "FILE: what", in one line.
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what);

/// Reads the grids for which `wanted`, by position in the file, is true, in the order of the file. No two of the
/// returned grids share a tree. Values must be floats or doubles; doubles become floats. \throw InputError if OpenVDB
/// cannot read a grid, values are not finite, or the number of active voxels differs from the metadata.
std::vector<VdbGrid> read_trees(const std::filesystem::path& file, const VdbStructure& structure,
                                const std::vector<bool>& wanted);

}
