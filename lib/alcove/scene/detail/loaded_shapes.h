/// Loads the files of the shapes of a scene and computes their boxes. Grids are built later, because their voxels
/// depend on the size of the whole scene.
#pragma once

#include "alcove/grid/grid_stack.h"
#include "alcove/mesh/mesh.h"
#include "alcove/scene/detail/pose.h"

namespace alcove {

struct LoadedShape {
    const SceneObject* object;
    Pose pose;                         ///< maps the space of the shape to scene space
    Box box{};                         ///< scene units; empty for infinite shapes
    Mesh mesh{};                       ///< for mesh shapes
    std::vector<Triangle> triangles{}; ///< for mesh shapes
    GridStack stack{};                 ///< for level sets, and for meshes once voxelized
    std::vector<LoadedShape> parts{};  ///< for composites
    std::vector<std::string> warnings{};
};

/// Loads the shapes of all objects. Keeps pointers to the objects. \throw InputError naming the object or its file:
/// what read_mesh() and read_grids() throw; a plane in a union or as the first part of a difference.
std::vector<LoadedShape> load_shapes(const Scene& scene);

/// Calls `visit(loaded)` for every shape and, recursively, its parts.
template <class Shapes, class Visit>
void for_each_shape(Shapes& shapes, const Visit& visit) {
    for (auto& loaded : shapes) {
        visit(loaded);
        for_each_shape(loaded.parts, visit);
    }
}

}
