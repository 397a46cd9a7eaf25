/// From shapes to fields: meshes voxelized, level sets extended, all placed in the unit space of the scene.
#pragma once

#include "alcove/field/field.h"
#include "alcove/field/primitives.h"
#include "alcove/scene/detail/loaded_shapes.h"

namespace alcove {

/// What all fields of a scene have in common.
struct BuildContext {
    Frame frame;  ///< of unit space
    float radius; ///< of occlusion, which voxels follow, unit space
    float reach; ///< as far as distances are to be right, unit space; 0 where nothing but the eye's rays asks
    double memory_limit; ///< bytes that the grids of each loaded may take
    Progress progress{}; ///< of one grid
};

/// Makes the stack of a mesh, and extends that of a level set to the reach. With `inside`, distances of the inside are
/// right as far, too. Warnings go to the loaded. \throw InputError naming the object or its file: what
/// voxelize() and extend_levels() throw, and a difference or blended union of what is no solid; LimitError as
/// voxelize().
AnyField field_of(LoadedShape& loaded, const BuildContext& context, bool inside = false);

/// That of a loaded whose shape is one.
Plane plane_of(const LoadedShape& loaded, const Frame& frame);

}
