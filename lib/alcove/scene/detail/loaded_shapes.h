/// Loads the files that the shapes of a scene use, each file once, and computes the boxes of the shapes. Grids are
/// built later, because their voxels depend on the size of the whole scene.
#pragma once

#include "alcove/grid/grid_stack.h"
#include "alcove/mesh/mesh.h"
#include "alcove/scene/detail/memory_estimate.h"
#include "alcove/scene/detail/own_colors.h"
#include "alcove/scene/detail/pose.h"

#include <memory>

namespace alcove {

/// The data of a mesh file. Shapes with the same file and weld share it.
struct LoadedMesh {
    Mesh mesh;
    std::vector<Triangle> triangles;
    std::optional<OwnColors> colors{}; ///< set if an object shows its own colours
};

struct LoadedShape {
    const SceneObject* object;
    Pose pose;                                ///< maps the space of the shape to scene space
    Box box{};                                ///< scene units; empty for infinite shapes
    float reach = 0.0f;                       ///< distances must be correct up to this value, unit space of the scene
    bool inside = false;                      ///< whether distances inside must be correct as well
    std::shared_ptr<const LoadedMesh> mesh{}; ///< for mesh shapes
    GridStack stack{};                        ///< for level sets, and for meshes once voxelized
    std::vector<LoadedShape> parts{};         ///< for composites
    std::vector<std::string> warnings{};      ///< only the first shape that uses a file has its warnings
};

/// Loads the shapes of all objects. Keeps pointers to the objects. Adds the memory that the files need to the estimate
/// `memory`. \throw what read_mesh() and read_grids() throw; InputError also for a plane that is in a union, or the
/// first part of a difference; LimitError if the files exceed the limit. The messages name the object or its file.
std::vector<LoadedShape> load_shapes(const Scene& scene, MemoryEstimate& memory);

/// Calls `visit(loaded)` for every shape and, recursively, its parts.
template <class Shapes, class Visit>
void for_each_shape(Shapes& shapes, const Visit& visit) {
    for (auto& loaded : shapes) {
        visit(loaded);
        for_each_shape(loaded.parts, visit);
    }
}

}
