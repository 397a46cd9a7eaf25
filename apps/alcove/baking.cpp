#include "baking.h"

#include "time_estimate.h"

#include "alcove/bake/detail/planned_bake.h"
#include "alcove/grid/detail/plan.h"
#include "alcove/occlusion/detail/thin_walls.h"

#include <fmt/format.h>

#include <limits>
#include <map>

namespace alcove::cli {

Needs BakeTask::needs() const {
    return needs_of(method ? *method : find_method("exact"), wanted);
}

std::string thin_wall_warning(double rmse, const Method& method, std::span<const Surfel> surfels,
                              const Occluders& occluders, double diagonal,
                              const std::function<double()>& finest_voxel) {
    constexpr double small_rmse = 0.03;
    if (rmse <= small_rmse || method.needs_mesh || !method.has_parameter("rays"))
        return {};
    const AnyField& field = occluders.field();
    const ThinWalls walls = thin_walls(surfels, occluders.rays(), resolution(field), two_sided(field));
    if (!walls.noticeable())
        return {};
    constexpr double clearly = 0.98; // finer, for the voxel is told by three digits
    const double told = clearly * double(walls.voxel);
    const std::string finer =
        told < finest_voxel() ? "" : fmt::format("--voxel {:.3g}, or ", told * diagonal);
    return fmt::format(
        "{:.1f} % of the vertices are on walls too thin for the voxel of {:.3g}, and rays through "
        "the grid may pass them: use {}--method guided, whose rays meet the triangles",
        100.0 * walls.share, double(resolution(field)) * diagonal, finer);
}

Baked bake_whole(VoxelizedMesh& input, const Surroundings& surroundings, const BakeTask& task,
                 std::span<const Surfel> surfels, const Progress& progress) {
    Stopwatch watch;
    Needs needs = task.needs();
    const bool with_pilot = task.planning.pilot && task.wanted.has(Channel::ao);
    needs.rays = needs.rays || with_pilot;
    const Occluders occluders =
        surroundings.around(input.mesh, input.triangles, input.stack, input.frame, needs);
    Baked baked{choice_of(*task.method, task.settings), {}, facts_of(input.stack)};
    baked.grid_seconds = watch.lap();
    refuse_late_bake(surfels, occluders, *task.method, task.settings, task.wanted);
    baked.values = bake_channels(surfels, occluders, *task.method, task.settings, task.wanted, progress);
    watch.lap();
    if (with_pilot) {
        const Pilot pilot(surfels, occluders.rays(), task.settings.radius, pilot_beside(baked.choice.rays()));
        if (!pilot.empty()) {
            baked.rmse = pilot.rmse(baked.values[Channel::ao]);
            const auto finest = [&] {
                const bool is_of_a_file = !input.stack.creator.empty(); // its voxel is what it is
                return is_of_a_file ? std::numeric_limits<double>::infinity()
                                    : finest_voxel(surface_size(input.mesh, input.triangles),
                                                   input.triangles.size(), input.options.grid);
            };
            const std::string warning = thin_wall_warning(*baked.rmse, *task.method, surfels, occluders,
                                                          input.frame.diagonal, finest);
            if (!warning.empty())
                input.warnings.push_back(warning);
        }
        baked.pilot_seconds = watch.lap();
    }
    return baked;
}

Baked bake_by_plan(VoxelizedMesh& input, Surroundings& surroundings, const BakeTask& task,
                   std::span<const Surfel> surfels, const CommonOptions& common, const Progress& progress) {
    Stopwatch watch;
    Baked baked;
    const float radius = task.settings.radius;
    const RaySurface surface =
        surroundings.around(input.mesh, input.triangles, input.stack, input.frame, {.rays = true}).rays();
    baked.grid_seconds = watch.lap();
    const Pilot pilot(surfels, surface, radius, pilot_for(*task.planning.error));
    const bool has_grid = !input.stack.levels.empty();
    const std::size_t known_warnings = input.warnings.size();
    std::map<float, GridFacts> grids;
    const auto make_field = [&](float largest_voxel) {
        Stopwatch making;
        if (!has_grid) {
            input.warnings.resize(known_warnings); // another grid says the same again
            input.options.grid.largest_voxel = largest_voxel;
            make_stack(input, common);
            surroundings.voxelize(input);
        }
        AnyField field =
            surroundings.around(input.mesh, input.triangles, input.stack, input.frame, {.field = true})
                .field();
        grids[largest_voxel] = facts_of(input.stack);
        baked.grid_seconds += making.lap();
        return field;
    };
    baked.pilot_seconds = watch.lap();
    const SurfaceSize size = surface_size(input.mesh, input.triangles);
    const double finest = surroundings.fit() ? finest_voxel(size, input.triangles.size(), input.options.grid)
                                             : std::numeric_limits<double>::infinity();
    const PlanRequest request{.error = *task.planning.error,
                              .radius = radius,
                              .seed = task.seed,
                              .surfels = surfels.size(),
                              .triangles = input.triangles.size(),
                              .area = size.area,
                              .finest_voxel = finest,
                              .has_grid = has_grid,
                              .wanted = task.wanted};
    PlannedBake planned = bake_planned(surfels, surface, make_field, pilot, request, progress,
                                       [&](const Plan& plan) { refuse_late_plan(plan, request, pilot); });
    baked.choice = planned.plan.choice;
    baked.values = std::move(planned.values);
    if (has_grid)
        baked.grid = facts_of(input.stack);
    else if (planned.plan.largest_voxel > 0.0f)
        baked.grid = grids.at(planned.plan.largest_voxel);
    if (!pilot.empty())
        baked.rmse = planned.rmse;
    return baked;
}

}
