/// Chooses which grids of a .vdb file are read.
#pragma once

#include "alcove/vdb/detail/structure.h"

#include <filesystem>
#include <string>
#include <vector>

namespace alcove {

/// Flags the grids to read, by position in the file. With names, these are the grids of those names, and all levels of
/// a stack if one of its levels is named. Without names, these are all level sets, or, if there is none, all grids
/// without a class; a warning is added for each level set that cannot be read.
/// \throw InputError if there is no grid to read, or if a named grid is missing or cannot be read.
std::vector<bool> choose(const VdbStructure& structure, const std::vector<std::string>& names,
                         const std::filesystem::path& file, std::vector<std::string>& warnings);

}
