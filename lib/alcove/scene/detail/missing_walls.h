/// Detects walls of a mesh that are missing from its field because they are too thin for its grid.
#pragma once

#include "alcove/field/field.h"
#include "alcove/grid/detail/plan.h"
#include "alcove/scene/detail/loaded_shapes.h"

namespace alcove {

/// A warning about missing walls of a solid, or an empty string. The warning is given if the field has no inside next
/// to at least a hundredth of the surface, and at least a hundredth of the surface belongs to thin walls rather than to
/// edges. It states the share of these walls, and a voxel that resolves them. `field` is the field of this shape only,
/// in the unit space of `frame`; `options` are the options of its grid. Cost: two map() calls at each of 4,096 points;
/// if a hundredth of them have no inside, also one RaySurface and two calls of thin_walls().
std::string missing_walls(const LoadedShape& loaded, const AnyField& field, const Frame& frame,
                          const GridOptions& options);

}
