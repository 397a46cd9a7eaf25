/// Builds the fields of shapes and places them in the unit space of the scene.
#pragma once

#include "alcove/field/field.h"
#include "alcove/field/primitives.h"
#include "alcove/scene/detail/loaded_shapes.h"
#include "alcove/scene/detail/shared_grids.h"

namespace alcove {

/// Sets the distance up to which the fields of a shape and its parts must be correct: `reach`, in unit space. If
/// `inside` is set, distances inside must be correct as well.
void set_reach(LoadedShape& loaded, float reach, bool inside, const Frame& frame);

/// The field of a shape in the unit space of `frame`. \throw everything that SharedGrids::field() throws. InputError
/// also for an open surface in a difference or blended union. These messages name the object or its file. LimitError as
/// voxelize().
AnyField field_of(LoadedShape& loaded, const Frame& frame, SharedGrids& grids);

/// The plane of a PlaneShape, in unit space.
Plane plane_of(const LoadedShape& loaded, const Frame& frame);

}
