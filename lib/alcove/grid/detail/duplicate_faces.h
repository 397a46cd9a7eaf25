/// Faces that are there twice, once from each side. Internal to grid/.
#pragma once

#include "alcove/base/types.h"

#include <span>
#include <vector>

namespace alcove {

/// The triangles in their order, of those on the same three places, whichever way they turn, only the first: where both sides
/// of a sheet are modelled, the distances on either side are those to the faces that were named first. Places are the
/// same where their coordinates are. Cost: about 50 ns a triangle.
std::vector<Triangle> without_duplicate_faces(std::span<const Vec3d> positions,
                                              std::span<const Triangle> triangles);

}
