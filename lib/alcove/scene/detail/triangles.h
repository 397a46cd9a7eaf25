/// The triangles of a scene, for mesh normals, mesh colours and exact rays.
#pragma once

#include "alcove/render/renderer.h"
#include "alcove/scene/detail/loaded_shapes.h"

namespace alcove {

/// The triangles of meshes with normals or colours of their own; with `all`, the triangles of every object: also other
/// meshes, other shapes as the zero isosurface of their fields on voxels of 1/256 of their size, and grounds up to the
/// length of the longest ray. `parts` belong to the shapes other than planes, in the same order. Null if there are no
/// such triangles. \throw InputError naming the object: painted without vertex colours, or a sheet that is not a mesh.
std::shared_ptr<const RenderableMesh> triangles_of(const std::vector<LoadedShape>& shapes,
                                                   const std::vector<Part>& parts, const std::vector<Ground>& grounds,
                                                   const Frame& frame, bool all);

}
