/// From where rays meet a field to where they meet the triangles behind it.
#pragma once

#include "alcove/render/detail/camera_rays.h"

namespace alcove {

/// Moves the samples [begin, end) onto the nearest triangle within three voxels along their rays, if there is one: places,
/// depths, normals where the mesh has them, toward the eye, and painted values where `hits` has room for them. The others stay
/// as they are. The renderable has a mesh. Thread-safe. Cost: a ray a sample.
void snap(const Renderable& renderable, const Camera& camera, std::size_t begin, std::size_t end, Hits& hits);

}
