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

bool begins_as_ply(const FileBytes& file);
bool begins_as_obj(const FileBytes& file);
bool begins_as_off(const FileBytes& file);
bool begins_as_stl(const FileBytes& file);

// Each returns what the format could not hold, one line each, and throws IoError.
std::vector<std::string> write_ply(const Mesh& mesh, const std::filesystem::path& file,
                                   const WriteOptions& options);
std::vector<std::string> write_obj(const Mesh& mesh, const std::filesystem::path& file,
                                   const WriteOptions& options);

/// Ends the face whose corners were pushed since the last call. \throw LimitError beyond 2^32 corners.
void close_face(Mesh& mesh);

/// n at unit length; zero where it has no finite, positive length.
Vec3 unit_or_zero(const Vec3d& n);

}
