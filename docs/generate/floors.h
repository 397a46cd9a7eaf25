/// Baselines for a bake: simple operations on the same data.
#pragma once

#include <filesystem>
#include <string>

namespace alcove::docs {

/// Compares reading and writing a mesh with reading and writing its bytes, map() with a fetch from a dense array, and
/// voxelizing with a copy of its input and output.
std::string baselines_section(const std::filesystem::path& file);

}
