/// Kinds and extensions of files.
#pragma once

#include <filesystem>
#include <string>

struct stat;

namespace alcove {

/// "a folder", "a pipe", "a socket" or "a device"; null for a regular file.
const char* special_kind(const struct stat& status);

/// The extension of a file name, in lower case: ".ply".
std::string lower_extension(const std::filesystem::path& file);

}
