/// Refuses bakes that would clearly miss the deadline.
#pragma once

#include "alcove/bake/detail/deadline.h"
#include "alcove/bake/detail/pilot.h"
#include "alcove/bake/detail/planner.h"
#include "alcove/occlusion/catalog.h"

#include <cstdint>
#include <span>

namespace alcove {

/// Estimates the time of a bake from a trial with 128 surfels, which are spread over the mesh. Repeats the trial with
/// twice as many surfels as long as the outcome is uncertain. All trials together bake at most a quarter of the
/// surfels; a bake of fewer than about a thousand surfels is not checked. \throw like Deadline::check(); the message
/// names settings that stay within the limit
void check_time(const Deadline& deadline, std::span<const Surfel> surfels, std::span<const std::uint32_t> order,
                const Occluders& occluders, const MethodChoice& choice, Settings settings, ChannelSet wanted);

/// The same for a plan. The time comes from the planner's cost table, which assumes a machine as fast as the one on
/// which the table was measured.
void check_time(const Deadline& deadline, const Plan& plan, const PlanRequest& request, const Pilot& pilot);

}
