/// Finds coincident vertices, which files duplicate at seams of textures or normals.
#pragma once

#include "alcove/base/types.h"

#include <span>
#include <vector>

namespace alcove {

/// For each vertex, the first vertex with exactly the same coordinates, which may be the vertex itself.
///
/// −0 equals 0; a vertex with a NaN coordinate equals no other. Cost: linear, about 50 ns per vertex.
std::vector<std::uint32_t> weld(std::span<const Vec3d> positions);

/// For each vertex, its representative: the nearest earlier vertex within `distance` (> 0) that represents itself, or
/// the vertex itself if there is none. Vertices that are not finite represent themselves. Cost: linear, about 300 ns
/// per vertex.
std::vector<std::uint32_t> weld(std::span<const Vec3d> positions, double distance);

}
