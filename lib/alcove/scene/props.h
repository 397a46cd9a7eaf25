/// What the shapes of a scene are made of: files read, and how much of the scene they take. No grid is made yet, for
/// that depends on how large the whole scene is.
#pragma once

#include "alcove/grid/grid_stack.h"
#include "alcove/mesh/mesh.h"
#include "alcove/scene/pose.h"

namespace alcove {

struct Prop {
    const SceneObject* object;
    Pose pose;                         ///< to the scene
    Box box{};                         ///< scene units; empty for what has no end
    Mesh mesh{};                       ///< of a mesh
    std::vector<Triangle> triangles{}; ///< of a mesh
    GridStack stack{};                 ///< of a level set
    std::vector<Prop> parts{};         ///< of a composite
    std::vector<std::string> warnings{};
};

/// The props of all objects. Keeps pointers to the objects. \throw InputError naming the object or its file: what
/// read_mesh() and read_grids() throw; a plane in a union, or cut by others.
std::vector<Prop> fetch_props(const Scene& scene);

/// Calls `visit(prop)` for every prop and the parts within.
template <class Props, class Visit>
void for_each_prop(Props& props, const Visit& visit) {
    for (auto& prop : props) {
        visit(prop);
        for_each_prop(prop.parts, visit);
    }
}

}
