/// The readers and writers of the formats, which read_mesh() and write_mesh() call.
#pragma once

#include "alcove/mesh/formats/file_bytes.h"
#include "alcove/mesh/mesh.h"

#include <filesystem>

namespace alcove {

/// Like read_mesh(), for a file in memory.
Mesh read_bytes(const FileBytes& file);

// Each reader throws InputError for damaged files. A mesh without faces is refused by the reader if a line of the file
// says that there are none, otherwise by read_bytes().
Mesh read_ply(const FileBytes& file);
Mesh read_obj(const FileBytes& file);
Mesh read_off(const FileBytes& file);
Mesh read_stl(const FileBytes& file);
Mesh read_gltf(const FileBytes& file);

bool begins_as_ply(const FileBytes& file);
bool begins_as_obj(const FileBytes& file);
bool begins_as_off(const FileBytes& file);
bool begins_as_stl(const FileBytes& file);
bool begins_as_gltf(const FileBytes& file);

/// A FileBytes::Head: the number of bytes that read_gltf() needs in memory. For a .glb, they end with the JSON; any
/// other file is needed as a whole.
std::size_t head_of_glb(std::string_view first_bytes);

// Each writer returns the messages of write_mesh(), and throws IoError if it fails.
std::vector<std::string> write_ply(const Mesh& mesh, const std::filesystem::path& file);
std::vector<std::string> write_obj(const Mesh& mesh, const std::filesystem::path& file);
std::vector<std::string> write_gltf(const Mesh& mesh, const std::filesystem::path& file);

/// \throw InputError for a file of `count` points and no faces. The message names the line at `place`, which says so.
[[noreturn]] void fail_without_faces(const FileBytes& file, const char* place, std::size_t count);

/// Ends the face whose corners were added since the last call. \throw LimitError beyond 2^32 corners.
void close_face(Mesh& mesh);

/// Whether a text is only the padding at the end of a file: NUL bytes, the Ctrl-Z of DOS, and blanks.
bool is_padding(std::string_view text);

/// Converts a colour component in the range 0 to 255 to a byte; 0 if it is not a number.
std::uint8_t color_byte(double value);

}
