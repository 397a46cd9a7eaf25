/// Clips a mesh to a box.
#pragma once

#include "alcove/mesh/mesh.h"

namespace alcove {

/// The parts of the triangles within the box, by polygon clipping (Sutherland and Hodgman 1974).
/// Neighbours cut a common edge at the same point, so they remain neighbours. The result has only positions and
/// faces, and is open where it was cut. Cost: linear.
Mesh clip(const Mesh& mesh, std::span<const Triangle> triangles, const Box& box);

}
