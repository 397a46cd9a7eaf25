/// How long work will take, told by a small part of it: where the time limit clearly does not suffice, it is not begun.
#pragma once

#include "alcove/accuracy/method_choice.h"
#include "alcove/accuracy/planner.h"
#include "alcove/render/camera.h"

#include <functional>
#include <string>

namespace alcove::cli {

/// What to ask for instead, as "--rays 20", given how much of the work fits, in (0, 1); empty where nothing helps.
using Remedy = std::function<std::string(double share)>;

/// \throw LimitError where work of so many seconds, wall clock, takes over twice those that are left: estimates err.
void refuse_if_late(double seconds, const Remedy& remedy);

/// The rest is for a time limit alone: without one none of it works.

/// Bakes 128 surfels from all over, and twice as many again while that takes little, at most an eighth of them; of fewer than
/// a thousand none.
void refuse_late_bake(std::span<const Surfel> surfels, const Occluders& occluders, const Method& method,
                      const Settings& settings, ChannelSet wanted);

/// By what the planner's table tells, on machines as fast as that of the table.
void refuse_late_plan(const PlanRequest& request, const Pilot& pilot);

/// `draw` draws a picture of a size; of several that are wanted one is drawn, at a 16th and a 64th of the size.
void refuse_late_pictures(ImageSize size, std::size_t count, const std::function<void(ImageSize)>& draw);

}
