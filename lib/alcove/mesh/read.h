/// Reads PLY, OBJ, OFF and STL files into a Mesh, losing nothing and trusting nothing.
#pragma once

#include "alcove/mesh/mesh.h"

#include <filesystem>

namespace alcove {

/// Reads a mesh; the format follows from the file's first bytes, then from its extension.
///
/// Vertex and face counts and order are the file's (an STL's corners are joined where their coordinates are equal
/// to the bit). Non-finite vertices and faces of fewer than three corners are kept and told in `Mesh::warnings`.
///
/// \throw InputError naming file, line or byte and mend: unknown format, damaged header, counts larger than what is
///        left of the file, an index out of range, a token that is no number, an early end, no faces at all.
/// \throw IoError if the file cannot be opened or read.
Mesh read_mesh(const std::filesystem::path& file);

}
