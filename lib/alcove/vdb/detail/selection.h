/// Chooses which grids of a .vdb file are read.
#pragma once

#include "alcove/vdb/detail/structure.h"

#include <filesystem>
#include <string>
#include <vector>

namespace alcove {

/// By position in the file: the grids of those names, with all levels of a stack if one of them is named. Without
/// names: all level sets, or else all grids without a class. Adds a warning for each level set that cannot be read.
/// \throw InputError if there are none, or if one that is named is missing or cannot be read.
std::vector<bool> choose(const VdbStructure& structure, const std::vector<std::string>& names,
                         const std::filesystem::path& file, std::vector<std::string>& warnings);

}
