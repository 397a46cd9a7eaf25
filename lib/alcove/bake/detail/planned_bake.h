/// A bake that is planned, and held to its error.
#pragma once

#include "alcove/bake/detail/planner.h"
#include "alcove/field/field.h"

#include <functional>

namespace alcove {

/// The field of a grid whose chosen voxel is that at most; asked once for each.
using MakeField = std::function<AnyField(float largest_voxel)>;

struct PlannedBake {
    Plan plan;
    std::vector<Plan> failed; ///< of earlier bakes, whose error was too large
    ChannelValues values;
    double rmse = 0.0;              ///< as the pilot tells
    double predicted_seconds = 0.0; ///< CPU seconds of all bakes that were made, as Plan::seconds
};

/// Bakes by the cheapest plan, and by others where its error turns out too large at the pilot's surfels; exact
/// rays end it. The wanted channels hold ao; those that exact rays do not give need `request.has_grid`. `surface`
/// is what the pilot was made with. `approve` is told of every plan before it is followed, and may throw.
PlannedBake bake_planned(std::span<const Surfel> surfels, const RaySurface& surface,
                         const MakeField& make_field, const Pilot& pilot, const PlanRequest& request,
                         const Progress& progress = {}, const std::function<void(const Plan&)>& approve = {});

}
