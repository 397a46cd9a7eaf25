/// Removes duplicate (double-sided) faces.
#pragma once

#include "alcove/base/types.h"

#include <span>
#include <vector>

namespace alcove {

/// Keeps only the first of the triangles with the same three corner positions, in either orientation, and preserves the
/// order. Where both sides of a sheet are modelled, the orientation of the first face decides the sign. Positions are
/// compared exactly. Cost: about 50 ns per triangle.
std::vector<Triangle> without_duplicate_faces(std::span<const Vec3d> positions, std::span<const Triangle> triangles);

}
