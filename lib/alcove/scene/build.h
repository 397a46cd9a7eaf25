/// From the description of a scene to what can be drawn: files read, meshes voxelized, all in one unit space.
#pragma once

#include "alcove/render/renderer.h"
#include "alcove/scene/scene.h"

namespace alcove {

struct BuiltScene {
    Renderable renderable;
    std::vector<Vec3d> points; ///< of what is bounded, to aim a camera at; scene units
    float radius = 0.0f;       ///< of occlusion, unit space
    double voxel = 0.0;        ///< the coarsest of the objects' finest, scene units; 0 without grids
    std::size_t levels = 0;    ///< of the object that has most
    std::vector<std::string> warnings{};
};

/// Unit space is that of the box around all that is bounded; its diagonal is what a radius in % is of. Level sets that
/// do not reach as far as occlusion and soft shadows ask, for these passes, are extended, as extend_levels() does. The
/// ground lies across the `up` of the scene's camera.
///
/// \throw InputError naming the object and its file: what read_mesh(), read_grids() and voxelize() throw; a difference
/// or blended union of what is no solid; a plane in a union or cut by others; nothing to see. LimitError as voxelize().
BuiltScene build_scene(const Scene& scene, PassSet passes = standard_passes, const Progress& progress = {});

/// How a built scene is drawn. Rays of occlusion are 16 a sample unless the scene says how many.
RenderOptions rendering_of(const Scene& scene, const BuiltScene& built, const Camera& camera,
                           PassSet passes = standard_passes);

}
