/// Clips a mesh to a box.
#pragma once

#include "alcove/mesh/mesh.h"

namespace alcove {

/// The parts of the triangles that lie within the box, by polygon clipping (Sutherland and Hodgman 1974). Two triangles
/// are cut at the same point of their common edge, so the parts still meet, but a cut triangle shares no vertices with
/// others. The result has only positions and faces, and is open where the box cut it. Cost: linear.
Mesh clip(const Mesh& mesh, std::span<const Triangle> triangles, const Box& box);

}
