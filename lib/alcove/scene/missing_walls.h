/// Walls of a mesh that are not in its field, as they are too thin for its grid.
#pragma once

#include "alcove/field/any_field.h"
#include "alcove/grid/plan.h"
#include "alcove/scene/props.h"

namespace alcove {

/// What to say where a 20th of the surface of a solid or more is thin walls without an inside in the field: how much, and
/// the voxel that mends it; else empty. Less than that may be edges, which grids round. The field is that of the prop alone,
/// in the unit space of `frame`, `options` what its grid was made with. Cost: two map() calls for each of 4,096 places; where
/// there is something to say, also the time of RaySurface and thin_walls().
std::string missing_walls(const Prop& prop, const AnyField& field, const Frame& frame,
                          const GridOptions& options);

}
