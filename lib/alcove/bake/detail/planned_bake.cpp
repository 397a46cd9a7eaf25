#include "alcove/bake/detail/planned_bake.h"

#include "alcove/base/errors.h"
#include "alcove/grid/detail/plan.h"

#include <map>

namespace alcove {
namespace {

/// Each field made when it is first asked for.
class Fields {
  public:
    explicit Fields(const MakeField& make) : make_(make) {}

    const AnyField& with_voxel(float largest) {
        const auto known = made_.find(largest);
        return known != made_.end() ? known->second : made_.emplace(largest, make_(largest)).first->second;
    }

  private:
    const MakeField& make_;
    std::map<float, AnyField> made_;
};

}

PlannedBake bake_planned(std::span<const Surfel> surfels, const RaySurface& surface,
                         const MakeField& make_field, const Pilot& pilot, const PlanRequest& request,
                         const Progress& progress, const std::function<void(const Plan&)>& approve) {
    Planner planner(request, pilot);
    Fields fields(make_field);
    PlannedBake result;
    for (;;) {
        result.plan = planner.next();
        if (approve)
            approve(result.plan);
        const MethodChoice& choice = result.plan.choice;
        const float voxel = request.has_grid ? GridOptions{}.largest_voxel : result.plan.largest_voxel;
        const AnyField* field = nullptr;
        try {
            field = voxel > 0.0f ? &fields.with_voxel(voxel) : nullptr;
        } catch (const LimitError&) { // less could be left out of the surface than was planned
            planner.leave_out(result.plan.largest_voxel);
            continue;
        }
        const Occluders occluders = field ? Occluders(*field, surface) : Occluders(surface);
        Settings settings = choice.settings(request.radius);
        if (choice.method->needs_mesh)
            settings.parameters.emplace_back("seed", request.seed);
        result.values = bake_channels(surfels, occluders, *choice.method, settings, request.wanted, progress);
        result.rmse = pilot.rmse(result.values[Channel::ao]);
        result.predicted_seconds += result.plan.seconds;
        if (result.rmse <= request.error || result.plan.largest_voxel == 0.0f)
            return result;
        planner.learn(result.plan, result.rmse);
        result.failed.push_back(result.plan);
    }
}

}
