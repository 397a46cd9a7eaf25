/// One reader and one writer a format, behind read_mesh() and write_mesh().
#pragma once

#include "alcove/mesh/formats/file_bytes.h"
#include "alcove/mesh/mesh.h"
#include "alcove/mesh/write.h"

namespace alcove {

/// read_mesh() of a file in memory.
Mesh read_bytes(const FileBytes& file);

// Each throws InputError for damage. A mesh without faces is left to read_bytes() to refuse where no line of
// the file says that there are none.
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

/// \throw InputError for a file of `count` points and no faces, naming the line at `place` that says so.
[[noreturn]] void fail_without_faces(const FileBytes& file, const char* place, std::size_t count);

/// Ends the face whose corners were pushed since the last call. \throw LimitError beyond 2^32 corners.
void close_face(Mesh& mesh);

/// A colour component that runs to 255 as a byte; 0 if it is not a number.
std::uint8_t color_byte(double value);

}
