/// Finds the vertices that lie at the same place, which files keep apart for seams of texture or normals.
#pragma once

#include "alcove/base/types.h"

#include <span>
#include <vector>

namespace alcove {

/// For each vertex the first one with exactly the same coordinates, itself if there is none before it.
///
/// −0 equals 0; a vertex with a coordinate that is not a number equals none. Cost: linear, about 50 ns a
/// vertex.
std::vector<std::uint32_t> weld(std::span<const Vec3d> positions);

}
