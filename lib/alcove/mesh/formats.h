/// One reader and one writer a format, behind read_mesh() and write_mesh().
#pragma once

#include "alcove/mesh/file_bytes.h"
#include "alcove/mesh/mesh.h"
#include "alcove/mesh/write.h"

namespace alcove {

// Each throws InputError for damage. A mesh without faces is left to read_mesh() to refuse.
Mesh read_ply(const FileBytes& file);
Mesh read_obj(const FileBytes& file);
Mesh read_off(const FileBytes& file);
Mesh read_stl(const FileBytes& file);

// Each returns what the format could not hold, one line each, and throws IoError.
std::vector<std::string> write_ply(const Mesh& mesh, const std::filesystem::path& file,
                                   const WriteOptions& options);
std::vector<std::string> write_obj(const Mesh& mesh, const std::filesystem::path& file,
                                   const WriteOptions& options);

}
