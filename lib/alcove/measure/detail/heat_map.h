/// Renders errors on a mesh as an image.
#pragma once

#include "alcove/mesh/mesh.h"

#include <span>
#include <string>

namespace alcove {

/// Errors of this size and above are black.
inline constexpr float largest_drawn_error = 0.25f;

/// The absolute error of every vertex, from white (0) through orange and red to black, in the default view of
/// make_camera(). A PNG of 320 × 240 pixels as a data URI (Masinter 1998).
std::string heat_map(const Mesh& mesh, std::span<const Triangle> triangles, std::span<const float> errors);

}
