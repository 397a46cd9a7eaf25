/// The triangles of a scene, for mesh normals, mesh colours and exact rays.
#pragma once

#include "alcove/render/renderer.h"
#include "alcove/scene/detail/loaded_shapes.h"

namespace alcove {

/// The triangles of meshes that have normals, colours or a texture of their own. With `all`, the triangles of every
/// object and ground: of all meshes; of other shapes, the zero isosurface of the field on voxels of 1/256 of the
/// shape's size; and of grounds, a square as large as the longest ray reaches. `parts` belong to the shapes that are
/// not planes, in the same order. Null if there are no such triangles. \throw InputError if a painted mesh has no
/// vertex colours, or if a sheet is not a mesh. The message names the object.
std::shared_ptr<const RenderableMesh> triangles_of(const std::vector<LoadedShape>& shapes,
                                                   const std::vector<Part>& parts, const std::vector<Ground>& grounds,
                                                   const Frame& frame, bool all);

}
