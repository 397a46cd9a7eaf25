/// A look at the header of a .vdb before OpenVDB reads it, which believes every length that the header names.
#pragma once

#include <filesystem>

namespace alcove {

/// Follows the names and metadata of the file and of its grids, whose trees are not looked at. \throw InputError where
/// one is longer than what is left of the file. What is no .vdb passes: OpenVDB says so better.
void check_vdb_lengths(const std::filesystem::path& file);

}
