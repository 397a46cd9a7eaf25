/// A look at the header of a .vdb before OpenVDB reads it, which believes every length that the header names.
#pragma once

#include <filesystem>

namespace alcove {

/// Follows the names and metadata of the file and of its grids, and the nodes of trees of floats. \throw InputError where a
/// length is more than what is left of the file, or other than that of the values it is of. What is no .vdb passes:
/// OpenVDB says so better. Cost: reads the file once.
void check_vdb_lengths(const std::filesystem::path& file);

}
