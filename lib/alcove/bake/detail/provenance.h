/// Recognizes files that an earlier bake wrote.
#pragma once

#include "alcove/mesh/mesh.h"

#include <string_view>

namespace alcove {

/// The beginning of the comment that a bake adds to a file.
inline constexpr std::string_view provenance = "alcove ";

/// The comment of an earlier bake in the file; empty if there is none.
std::string_view earlier_bake(const Mesh& mesh);

/// Whether the vertex colours are the ao of an earlier bake: they are grey, and a PLY also has the `quality` that a
/// bake adds.
bool has_baked_colors(const Mesh& mesh);

}
