/// The triangles of a scene, where normals, painted values or exact rays ask for them.
#pragma once

#include "alcove/render/renderable.h"
#include "alcove/scene/detail/loaded_shapes.h"

namespace alcove {

/// Of the meshes that have normals or values of their own; with `all`, of everything: other meshes too, what is no mesh as
/// the zero surface of its field on voxels of 1/256 of itself, and grounds as far as rays go. `parts` are those of the shapes that are no
/// planes, in their order. Null where nothing asks. \throw InputError naming the object: painted without vertex colours, a
/// sheet that is no mesh.
std::shared_ptr<const RenderableMesh> triangles_of(const std::vector<LoadedShape>& shapes,
                                                   const std::vector<Part>& parts,
                                                   const std::vector<Ground>& grounds, const Frame& frame,
                                                   bool all);

}
