/// How long work will take, told by a small part of it: where the time limit clearly does not suffice, it is not begun.
#pragma once

#include "alcove/bake/detail/planner.h"
#include "alcove/occlusion/catalog.h"
#include "alcove/render/camera.h"

#include <functional>
#include <stdexcept>
#include <string>

namespace alcove::cli {

/// There is clearly not the time for what is asked.
struct OutOfTime : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Each does nothing without a time limit, and throws OutOfTime, naming what fits, where the work would take over twice the
/// seconds that are left: estimates err.

/// Bakes 128 surfels from all over on what the method is to see, and twice as many again while these leave it open whether
/// there is time enough, a quarter of all at most; of fewer than a thousand none.
void refuse_late_bake(std::span<const Surfel> surfels, const Occluders& occluders, const Method& method,
                      const Settings& settings, ChannelSet wanted);

/// By what the planner's table tells, on machines as fast as that of the table.
void refuse_late_plan(const Plan& plan, const PlanRequest& request, const Pilot& pilot);

/// `draw` draws a picture of a size: it is asked for a 16th and a 64th of the whole.
void refuse_late_picture(ImageSize size, const std::function<void(ImageSize)>& draw);

}
