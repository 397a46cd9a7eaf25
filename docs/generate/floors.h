/// What a bake could not be faster than, on the machine it runs on.
#pragma once

#include <filesystem>
#include <string>

namespace alcove::docs {

/// Reading and writing beside a byte read once and written once, map() beside a fetch from a dense array, a grid beside
/// a copy of what it is made from and of what it is.
std::string floors_section(const std::filesystem::path& file);

}
