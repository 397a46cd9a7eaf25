/// Recognizes files that an earlier bake wrote.
#pragma once

#include "alcove/mesh/mesh.h"

#include <string_view>

namespace alcove {

/// The beginning of the comment that a bake adds.
inline constexpr std::string_view provenance = "alcove ";

/// Whether the file was written by an earlier bake.
bool is_baked(const Mesh& mesh);

/// Whether the vertex colours are the ao of an earlier bake. If the mesh had colours of its own, the bake kept them and
/// a PLY has no `quality`.
bool has_baked_colors(const Mesh& mesh);

}
