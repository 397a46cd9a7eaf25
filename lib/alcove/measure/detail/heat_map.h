/// A picture of errors on a mesh.
#pragma once

#include "alcove/mesh/mesh.h"

#include <span>
#include <string>

namespace alcove {

/// The error that is drawn darkest.
inline constexpr float largest_drawn_error = 0.25f;

/// |error| of every vertex on the triangles, from white (none) over orange and red to black, seen as make_camera()
/// does by itself; a PNG of 320 × 240 as a data URI (L. Masinter, RFC 2397, 1998).
std::string heat_map(const Mesh& mesh, std::span<const Triangle> triangles, std::span<const float> errors);

}
