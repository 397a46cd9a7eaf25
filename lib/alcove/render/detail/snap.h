/// Moves ray hits from a field onto the triangles from which the field was made.
#pragma once

#include "alcove/render/detail/camera_rays.h"

namespace alcove {

/// Moves each sample in [begin, end) onto the first triangle of its object that its ray meets within three voxels of
/// the hit. Updates positions, depths, normals if the mesh has them (toward the eye), and colours if `hits.colors` is
/// not empty. If there is no such triangle, a sample of a part that is on_triangles shows what its ray meets next.
/// Other samples stay in place and get the colour of the nearest triangle. The renderable must have a mesh.
/// Thread-safe. Cost: one ray per sample.
void snap(const Renderable& renderable, const CameraRays& camera_rays, std::size_t begin, std::size_t end, Hits& hits);

}
