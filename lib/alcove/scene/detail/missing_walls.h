/// Walls of a mesh that are not in its field, as they are too thin for its grid.
#pragma once

#include "alcove/field/field.h"
#include "alcove/grid/detail/plan.h"
#include "alcove/scene/detail/loaded_shapes.h"

namespace alcove {

/// What to say where a hundredth of the surface of a solid or more has no inside in the field, and as much is thin walls
/// rather than edges: how much, and the voxel that mends it; else empty. The field is that of the loaded alone, in the unit
/// space of `frame`, `options` what its grid was made with. Cost: two map() calls for each of 4,096 places; where so many have
/// no inside, also the time of RaySurface and twice that of thin_walls().
std::string missing_walls(const LoadedShape& loaded, const AnyField& field, const Frame& frame,
                          const GridOptions& options);

}
