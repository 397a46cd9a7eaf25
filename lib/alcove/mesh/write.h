/// Writes a Mesh with its added attributes, as PLY or OBJ, whole or not at all.
#pragma once

#include "alcove/mesh/mesh.h"

#include <filesystem>

namespace alcove {

struct WriteOptions {
    std::vector<Color> colors;         ///< empty, or one a vertex: replaces the file's own colours
    std::vector<std::string> comments; ///< provenance: one line each
};

/// Writes to a temporary file beside `file` and renames it, so that a failure leaves the old file as it was.
///
/// PLY: binary little endian. All elements, properties and comments the input held, byte for byte where the input
/// was binary little endian too, then the added attributes as float vertex properties in the order they were added
/// (a property of the same name is replaced in place). OBJ: the input's text with colours on its `v` lines.
///
/// \return what the format could not hold, in words, one line each; empty when nothing was lost.
/// \throw InputError for another extension, naming the ones that work; IoError if the file cannot be written.
std::vector<std::string> write_mesh(const Mesh& mesh, const std::filesystem::path& file,
                                    const WriteOptions& options = {});

}
