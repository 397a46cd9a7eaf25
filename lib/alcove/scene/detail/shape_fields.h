/// Builds the fields of shapes and places them in the unit space of the scene.
#pragma once

#include "alcove/field/field.h"
#include "alcove/field/primitives.h"
#include "alcove/scene/detail/loaded_shapes.h"
#include "alcove/scene/detail/shared_grids.h"

namespace alcove {

/// Sets the distance `reach` (unit space) up to which the field of a shape must be correct, and the distances that its
/// parts need for this. If `inside` is set, distances inside must be correct as well.
void set_reach(LoadedShape& loaded, float reach, bool inside, const Frame& frame);

/// The field of a shape in the unit space of `frame`. \throw what SharedGrids::field() throws, and InputError for an
/// open surface in a difference or blended union. The messages name the object or its file.
AnyField field_of(LoadedShape& loaded, const Frame& frame, SharedGrids& grids);

/// The plane of a PlaneShape, in unit space.
Plane plane_of(const LoadedShape& loaded, const Frame& frame);

}
