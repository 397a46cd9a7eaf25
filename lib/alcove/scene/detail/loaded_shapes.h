/// What the shapes of a scene are made of: files read, and how much of the scene they take. No grid is made yet, for
/// that depends on how large the whole scene is.
#pragma once

#include "alcove/grid/grid_stack.h"
#include "alcove/mesh/mesh.h"
#include "alcove/scene/detail/pose.h"

namespace alcove {

struct LoadedShape {
    const SceneObject* object;
    Pose pose;                         ///< to the scene
    Box box{};                         ///< scene units; empty for what has no end
    Mesh mesh{};                       ///< of a mesh
    std::vector<Triangle> triangles{}; ///< of a mesh
    GridStack stack{};                 ///< of a level set
    std::vector<LoadedShape> parts{};  ///< of a composite
    std::vector<std::string> warnings{};
};

/// The shapes of all objects. Keeps pointers to the objects. \throw InputError naming the object or its file: what
/// read_mesh() and read_grids() throw; a plane in a union, or cut by others.
std::vector<LoadedShape> load_shapes(const Scene& scene);

/// Calls `visit(loaded)` for every loaded and the parts within.
template <class Shapes, class Visit>
void for_each_shape(Shapes& shapes, const Visit& visit) {
    for (auto& loaded : shapes) {
        visit(loaded);
        for_each_shape(loaded.parts, visit);
    }
}

}
