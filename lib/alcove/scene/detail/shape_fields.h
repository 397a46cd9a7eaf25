/// Builds the fields of shapes and places them in the unit space of the scene.
#pragma once

#include "alcove/field/field.h"
#include "alcove/field/primitives.h"
#include "alcove/scene/detail/loaded_shapes.h"
#include "alcove/scene/detail/shared_grids.h"

namespace alcove {

/// Sets the reach of a shape and its parts: `reach` in unit space; with `inside`, inside as well.
void set_reach(LoadedShape& loaded, float reach, bool inside, const Frame& frame);

/// The field of a shape in the unit space of `frame`. \throw InputError naming the object or its file: what
/// SharedGrids::field() throws, and an open surface in a difference or blended union; LimitError as voxelize().
AnyField field_of(LoadedShape& loaded, const Frame& frame, SharedGrids& grids);

/// The plane of a PlaneShape, in unit space.
Plane plane_of(const LoadedShape& loaded, const Frame& frame);

}
