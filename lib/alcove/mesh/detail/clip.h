/// Cuts away what of a mesh lies outside a box.
#pragma once

#include "alcove/mesh/mesh.h"

namespace alcove {

/// The triangles within the box, those across its sides cut there: I. E. Sutherland, G. W. Hodgman, "Reentrant
/// polygon clipping" (1974). Neighbours stay neighbours: both cut a common edge at the same point. Positions
/// and faces only; a mesh that is cut is open there. Cost: linear.
Mesh clip(const Mesh& mesh, std::span<const Triangle> triangles, const Box& box);

}
