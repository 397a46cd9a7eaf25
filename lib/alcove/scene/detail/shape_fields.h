/// Builds the fields of shapes: voxelizes meshes, extends level sets, and places all in the unit space of the scene.
#pragma once

#include "alcove/field/field.h"
#include "alcove/field/primitives.h"
#include "alcove/scene/detail/loaded_shapes.h"

namespace alcove {

/// Parameters shared by all fields of a scene.
struct BuildContext {
    Frame frame;         ///< maps unit space to scene space
    float radius;        ///< radius of occlusion, which determines voxels; unit space
    float reach;         ///< distances up to this must be correct, unit space; 0 if only camera rays need the field
    double memory_limit; ///< bytes for the grids of each shape
    Progress progress{}; ///< progress of one grid
};

/// The field of a shape. Voxelizes a mesh, and extends a level set to the reach; keeps the grid and the warnings in
/// `loaded`. With `inside`, distances inside are correct up to the reach as well. \throw InputError naming the object
/// or its file: what voxelize() and extend_levels() throw, and an open surface in a difference or blended union;
/// LimitError as voxelize().
AnyField field_of(LoadedShape& loaded, const BuildContext& context, bool inside = false);

/// The plane of a PlaneShape, in unit space.
Plane plane_of(const LoadedShape& loaded, const Frame& frame);

}
