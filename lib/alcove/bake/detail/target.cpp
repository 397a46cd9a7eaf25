#include "alcove/bake/detail/target.h"

#include "alcove/bake/detail/causes.h"
#include "alcove/bake/detail/planner.h"
#include "alcove/bake/detail/target_occluders.h"
#include "alcove/bake/detail/target_surfels.h"
#include "alcove/bake/detail/time_checks.h"
#include "alcove/base/detail/stopwatch.h"
#include "alcove/base/types.h"
#include "alcove/grid/detail/plan.h"
#include "alcove/occlusion/detail/interpolated.h"
#include "alcove/occlusion/detail/subset.h"
#include "alcove/occlusion/methods/traced.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alcove {
namespace {

OccluderNeeds needs_of(const Method& method, ChannelSet wanted, bool has_contacts = false) {
    OccluderNeeds needs{.field = false, .rays = has_contacts};
    for (const Method* needed : methods_for(method, wanted))
        needs = {needs.field || needed->needs_grid, needs.rays || needed->needs_mesh};
    return needs;
}

class TargetBake {
  public:
    TargetBake(BakeTarget& target, const BakeTask& task, Surroundings& surroundings, const BakeProgress& progress)
        : target_(target), task_(task), surroundings_(surroundings), progress_(progress),
          occluders_(target, surroundings, task.keep_grid, progress), surfels_(target, occluders_, result_.seconds) {}

    TargetResult run() {
        if (!is_dense())
            surfels_.find_contacts();
        if (!task_.error)
            bake_with_fixed_settings();
        else if (!task_.method || is_planned(*task_.method))
            bake_by_plan();
        else
            bake_with_tuned_samples();
        result_.grid = occluders_.summary();
        for (const std::string& warning : occluders_.warnings())
            result_.warnings.push_back(warning);
        if (result_.rmse) {
            warn_of_errors();
            result_.rmse = std::min(std::hypot(*result_.rmse, error_of_offset()), 1.0);
        }
        if (result_.rmse && task_.target_error && *result_.rmse > *task_.target_error)
            result_.warnings.push_back(
                fmt::format("{} reaches only an RMSE of {:.2g} on this mesh, not {:g}: allow a larger --error{}",
                            result_.choice.label(), *result_.rmse, *task_.target_error,
                            task_.method ? ", or leave out --method to let the planner choose" : ""));
        if (target_.more)
            bake_more();
        if (task_.keep_grid)
            result_.stack = occluders_.take_stack(GridOptions{}.largest_voxel);
        result_.seconds.grid += occluders_.seconds();
        return std::move(result_);
    }

  private:
    /// The error that arises where rays start higher than 1/1000 of the radius, as they must because coordinates are
    /// rounded. The pilot does not see this error, because its own rays start at the same height. On balls and grooves,
    /// the error was one to three times the height in units of the radius.
    double error_of_offset() const {
        constexpr double usual = 1e-3, error_per_height = 3.0;
        return error_per_height * std::max(ray_offset(target_.radius) / double{target_.radius} - usual, 0.0);
    }

    /// Whether the values of most surfels may be interpolated, so that their contacts need not be found.
    bool is_dense() const {
        constexpr std::size_t many_surfels = 100'000;
        return has_pilot() && task_.error && (!task_.method || is_planned(*task_.method)) &&
               target_.surfels.size() >= many_surfels;
    }

    OccluderNeeds needs_of(const Method& method, ChannelSet wanted) const {
        return alcove::needs_of(method, wanted, surfels_.may_touch());
    }

    static bool is_planned(const Method& method) {
        return method.needs_mesh || method.name == "calibrated"; // the cost table has only these
    }

    /// Whether there is a grid whatever the plan is, so that the planner cannot choose the voxel.
    bool has_fixed_grid() const {
        return target_.grid || task_.keep_grid || target_.voxelizing.grid.voxel > 0.0f ||
               alcove::needs_of(find_method("exact"), task_.attributes).field;
    }

    bool has_pilot() const { return task_.pilot && task_.attributes.has(Channel::ao); }

    Progress baking_progress() const {
        if (!progress_)
            return {};
        return [this](double done) { progress_("baking", done); };
    }

    Settings settings_of(const MethodChoice& choice) const {
        Settings settings = task_.settings;
        settings.radius = target_.radius;
        settings.labels = surfels_.known_pilot() ? surfels_.known_pilot()->labels() : nullptr;
        for (const auto& parameter : choice.settings(target_.radius).parameters)
            settings.parameters.push_back(parameter); // the last value of a parameter wins
        if (choice.method->samples_are == SampleKind::rays)
            settings.parameters.emplace_back("seed", task_.seed);
        return settings;
    }

    void evaluate_with(const MethodChoice& choice, const Settings& settings, float largest_voxel) {
        const OccluderNeeds needs = needs_of(*choice.method, task_.attributes);
        const Occluders occluders = occluders_.get(needs, largest_voxel);
        last_voxel_ = largest_voxel;
        if (!task_.error)
            check_time(task_.deadline, target_.surfels, surfels_.order(), occluders, choice, settings,
                       task_.attributes);
        const Progress progress = baking_progress();
        Stopwatch watch;
        result_.values = evaluate(target_.surfels, surfels_.order(), occluders, *choice.method, settings,
                                  task_.attributes, progress);
        result_.seconds.occlusion += watch.lap();
        result_.choice = choice;
    }

    /// Tests on a small sample whether interpolation pays off.
    bool pays(const Plan& plan, const Interpolation& interpolation, float largest_voxel) {
        constexpr std::size_t runs = 8, length = 2048;
        const std::vector<MethodRun> methods = runs_for(*plan.choice.method, settings_of(plan.choice), Channel::ao);
        const Occluders occluders = occluders_.get(needs_of(*plan.choice.method, task_.attributes), largest_voxel);
        Stopwatch watch;
        const std::vector<std::uint32_t> sample = surfels_.runs(runs, length);
        const std::vector<Surfel> some = pick(target_.surfels, sample);
        const auto prepare = [&](std::span<const std::uint32_t> indices, std::span<Surfel> surfels) {
            surfels_.find_contacts(pick(sample, indices), surfels);
        };
        const auto interpolated =
            evaluate_interpolated(some, spatial_order(some), occluders, methods.front(), interpolation, prepare);
        result_.seconds.occlusion += watch.lap();
        return interpolated.has_value();
    }

    /// Evaluates a plan at some of the surfels and interpolates the values of the others; see evaluate_interpolated().
    /// Attributes that cannot be interpolated are evaluated at all surfels. Keeps the values only if they meet the
    /// error.
    /// \return the RMSE; std::nullopt if too many surfels would have to be evaluated.
    std::optional<double> interpolate(const Plan& plan, const Interpolation& interpolation, float largest_voxel) {
        const Method& method = *plan.choice.method;
        const Settings settings = settings_of(plan.choice);
        const Occluders occluders = occluders_.get(needs_of(method, task_.attributes), largest_voxel);
        const Progress progress = baking_progress();
        const std::vector<MethodRun> runs = runs_for(method, settings, task_.attributes);
        const auto prepare = [&](std::span<const std::uint32_t> indices, std::span<Surfel> surfels) {
            surfels_.find_contacts(indices, surfels);
        };
        Stopwatch watch;
        std::optional<InterpolatedValues> interpolated = evaluate_interpolated(
            target_.surfels, surfels_.order(), occluders, runs.front(), interpolation, prepare, progress);
        result_.seconds.occlusion += watch.lap();
        if (!interpolated)
            return {};
        const double rmse = surfels_.known_pilot()->rmse(interpolated->values[Channel::ao]);
        result_.seconds.pilot += watch.lap();
        if (rmse > *task_.error)
            return rmse;
        result_.values = std::move(interpolated->values);
        for (std::size_t r = 1; r < runs.size(); ++r) {
            ChannelValues others = runs[r].method->bake(target_.surfels, surfels_.order(), occluders, runs[r].settings,
                                                        runs[r].wanted, progress);
            for (const ChannelInfo& channel : channels)
                if (!others[channel.channel].empty())
                    result_.values[channel.channel] = std::move(others[channel.channel]);
        }
        result_.seconds.occlusion += watch.lap();
        result_.choice = plan.choice;
        result_.evaluated = interpolated->share;
        result_.reason = plan.reason;
        result_.rmse = rmse;
        last_voxel_ = largest_voxel;
        return rmse;
    }

    /// Interpolates the values of most surfels if there are many surfels, if this is expected to be faster than
    /// evaluating the plan at all of them, and if the result meets the error. \return whether the interpolated values
    /// were kept.
    bool bake_interpolated(const PlanRequest& request, const Pilot& pilot, double seconds_of_all) {
        constexpr double usual_share = 0.15, max_share = 0.4, clearly_faster = 0.8;
        constexpr double seconds_per_surfel = 1.2e-7; // of the interpolation, on the machine of the planner's table
        if (!is_dense() || pilot.empty())
            return false;
        const auto surfels = static_cast<double>(request.surfels);
        PlanRequest some = request;
        some.surfels = static_cast<std::size_t>(usual_share * surfels);
        some.contacts = static_cast<std::size_t>(usual_share * static_cast<double>(request.contacts));
        if (!task_.method)
            some.max_rmse_of_calibrated = 0.85 * request.error;
        Planner planner(some, pilot);
        constexpr double very_many_surfels = 1e6;
        const std::size_t stride = surfels < very_many_surfels ? 16 : 64;
        for (Interpolation interpolation{stride, static_cast<float>(1.5 * request.error), max_share};
             interpolation.stride > 1; interpolation.stride /= 4, interpolation.tolerance /= 2.0f) {
            const Plan plan = planner.expected();
            if (plan.seconds + seconds_per_surfel * surfels > clearly_faster * seconds_of_all)
                return false;
            check_time(task_.deadline, plan, some, pilot);
            try {
                const float voxel = request.has_grid ? GridOptions{}.largest_voxel : plan.largest_voxel;
                if (!pays(plan, interpolation, voxel))
                    return false;
                const std::optional<double> rmse = interpolate(plan, interpolation, voxel);
                if (!rmse || *rmse <= request.error)
                    return rmse.has_value();
                planner.update(plan, *rmse);
            } catch (const LimitError&) { // the plan for all surfels handles this
                return false;
            }
        }
        return false;
    }

    void measure_error(const PilotOptions& options) {
        if (!has_pilot() || surfels_.pilot(options).empty())
            return;
        Stopwatch watch;
        result_.rmse = surfels_.known_pilot()->rmse(result_.values[Channel::ao]);
        result_.seconds.pilot += watch.lap();
    }

    /// Whether the voxels are fine enough for occluders within the radius.
    bool resolves_radius() {
        const Occluders occluders = occluders_.get({.field = true, .rays = false}, GridOptions{}.largest_voxel);
        return occluders.field().resolution() <= 0.5f * target_.radius;
    }

    /// The least number of rays per surfel for guided. It is higher if there are few surfels, which have few others to
    /// share rays with, or if the field is too coarse to help.
    int rays_for_few_or_unresolved() {
        constexpr std::size_t shared = 1 << 17; // rays of all surfels together, which take some hundredths of a second
        constexpr std::size_t most = 64;
        constexpr int unresolved = 32;
        const auto rays = static_cast<int>(std::min(shared / std::max<std::size_t>(target_.surfels.size(), 1), most));
        return resolves_radius() ? rays : std::max(rays, unresolved);
    }

    void bake_with_fixed_settings() {
        MethodChoice choice = choice_of(*task_.method, task_.settings);
        Settings settings = task_.settings;
        settings.radius = target_.radius;
        const bool chose_rays =
            std::any_of(settings.parameters.begin(), settings.parameters.end(),
                        [](const auto& parameter) { return parameter.first == parameter_of(SampleKind::rays); });
        const bool is_guided = choice.method->needs_grid && choice.method->needs_mesh;
        if (!chose_rays && (is_guided || choice.method->name == Traced::name)) {
            int rays = std::max(choice.samples, surfels_.cheap_rays());
            if (is_guided)
                rays = std::max(rays, rays_for_few_or_unresolved());
            choice = choose(*choice.method, rays);
            settings.parameters.emplace_back(parameter_of(SampleKind::rays), choice.samples);
        }
        if (has_pilot())
            settings.labels = surfels_.pilot(pilot_beside(choice.rays())).labels();
        evaluate_with(choice, settings, GridOptions{}.largest_voxel);
        measure_error(pilot_beside(choice.rays()));
    }

    static constexpr std::size_t sample_stride = 8;
    static constexpr double sample_tolerance = 1.08; // the error of a sample is accurate to about a tenth

    /// The error of a plan that uses the field, measured at an eighth of the surfels, so that a plan that misses the
    /// target costs little. The sample consists of runs along the Morton curve, because neighbours share rays.
    /// std::nullopt if there are few surfels, or if the grid does not fit in memory.
    std::optional<double> rmse_on_sample(const Plan& plan, bool has_grid) {
        constexpr std::size_t many_surfels = 100'000, runs = 64, stride = sample_stride;
        if (target_.surfels.size() < many_surfels || plan.largest_voxel == 0.0f)
            return {};
        if (sample_.empty())
            sample_ = surfels_.runs(runs, target_.surfels.size() / (runs * stride));
        try {
            const float voxel = has_grid ? GridOptions{}.largest_voxel : plan.largest_voxel;
            const Occluders occluders = occluders_.get(needs_of(*plan.choice.method, Channel::ao), voxel);
            Stopwatch watch;
            const std::vector<float> ao = evaluate(pick(target_.surfels, sample_), occluders, *plan.choice.method,
                                                   settings_of(plan.choice), Channel::ao)[Channel::ao];
            result_.seconds.occlusion += watch.lap();
            return surfels_.known_pilot()->rmse(ao, sample_);
        } catch (const LimitError&) { // the bake itself reports this
            return {};
        }
    }

    void bake_by_plan() {
        const SurfaceSize size = surface_size(target_.mesh, target_.triangles);
        const Pilot& pilot = surfels_.pilot(pilot_for(*task_.error));
        const bool has_grid = has_fixed_grid();
        const PlanRequest request{
            .error = *task_.error,
            .radius = target_.radius,
            .via = task_.via,
            .method = task_.method,
            .seed = task_.seed,
            .exact_rays = pilot.rays_for(*task_.error, task_.seed),
            .min_rays = surfels_.cheap_rays(),
            .surfels = target_.surfels.size(),
            .contacts = surfels_.contacts(),
            .triangles = target_.triangles.size(),
            .area = size.area,
            .finest_voxel = surroundings_.fit() ? finest_voxel(size, target_.triangles.size(), target_.voxelizing.grid)
                                                : std::numeric_limits<double>::infinity(),
            .allowed_seconds = PlanRequest{}.allowed_seconds * target_.share,
            .has_grid = has_grid,
            .wanted = task_.attributes};
        Planner planner(request, pilot);
        if (bake_interpolated(request, pilot, planner.expected().seconds))
            return;
        surfels_.find_contacts();
        for (;;) {
            check_time(task_.deadline, planner.expected(), request, pilot);
            const Plan plan = planner.next();
            if (const std::optional<double> rmse = rmse_on_sample(plan, has_grid);
                rmse && *rmse > sample_tolerance * *task_.error) {
                planner.update(plan, *rmse, 1.0 / sample_stride);
                continue;
            }
            try {
                evaluate_with(plan.choice, settings_of(plan.choice),
                              has_grid ? GridOptions{}.largest_voxel : plan.largest_voxel);
            } catch (const LimitError&) { // clustering merged fewer vertices than expected
                if (plan.largest_voxel == 0.0f || has_grid)
                    throw;
                planner.leave_out(plan.largest_voxel);
                continue;
            }
            result_.reason = plan.reason;
            measure_error({});
            if (!result_.rmse || *result_.rmse <= *task_.error || planner.is_last(plan))
                return;
            planner.update(plan, *result_.rmse);
        }
    }

    /// Tries a method on the pilot's surfels with more and more rays, then with finer voxels, until it meets the error
    /// or stops improving. The method must evaluate each surfel independently.
    void bake_with_tuned_samples() {
        constexpr float coarsest = GridOptions{}.largest_voxel;
        constexpr int first_rays = 8, max_rays = 4096;
        constexpr double no_improvement = 0.95; // ratio of errors
        const Method& method = *task_.method;
        const Pilot& pilot = surfels_.pilot(pilot_for(*task_.error));
        const bool chooses_voxel = !has_fixed_grid();
        struct Best {
            MethodChoice choice;
            float largest_voxel = coarsest;
            double rmse = std::numeric_limits<double>::infinity();
        } best;
        best.choice = choose(method);
        constexpr int max_halvings = 2;
        for (int halvings = 0; halvings <= max_halvings; ++halvings) {
            const float voxel = std::ldexp(coarsest, -halvings);
            const double coarser = best.rmse;
            Occluders occluders = occluders_.rays();
            try {
                occluders = occluders_.get({.field = true, .rays = false}, voxel);
            } catch (const LimitError&) {
                break;
            }
            const auto measure = [&](const MethodChoice& choice) {
                const double rmse = pilot.empty() ? 0.0 : pilot.rmse_of(method, occluders, settings_of(choice));
                if (rmse < best.rmse)
                    best = {choice, voxel, rmse};
                return rmse;
            };
            if (method.samples_are == SampleKind::rays) {
                double fewer = std::numeric_limits<double>::infinity();
                for (int rays = first_rays; rays <= max_rays && best.rmse > *task_.error; rays += rays / 2) {
                    const double rmse = measure(choose(method, rays));
                    if (rmse > no_improvement * fewer)
                        break;
                    fewer = rmse;
                }
            } else {
                measure(choose(method));
            }
            if (best.rmse <= *task_.error || !chooses_voxel || best.rmse > no_improvement * coarser)
                break;
        }
        evaluate_with(best.choice, settings_of(best.choice), best.largest_voxel);
        measure_error({});
    }

    void bake_more() {
        for (std::vector<Surfel> more = target_.more(result_.values[Channel::ao]); !more.empty();
             more = target_.more(result_.values[Channel::ao]))
            evaluate_more(more);
    }

    void evaluate_more(std::vector<Surfel>& more) {
        const RaySurface& rays = occluders_.rays();
        Stopwatch watch;
        alcove::find_contacts(more, rays, ray_offset(target_.radius), [&](std::size_t i, const Triangle& triangle) {
            return target_.is_own_face(target_.surfels.size() + i, triangle);
        });
        const Method& method = *result_.choice.method;
        const OccluderNeeds needs = alcove::needs_of(method, task_.attributes, true);
        const ChannelValues values = evaluate(more, spatial_order(more), occluders_.get(needs, last_voxel_), method,
                                              settings_of(result_.choice), task_.attributes);
        for (const ChannelInfo& channel : channels)
            result_.values[channel.channel].insert(result_.values[channel.channel].end(),
                                                   values[channel.channel].begin(), values[channel.channel].end());
        result_.seconds.occlusion += watch.lap();
    }

    void warn_of_errors() {
        const Method& method = *result_.choice.method;
        const Occluders occluders = occluders_.get({.field = method.needs_grid, .rays = true}, last_voxel_);
        for (std::string& warning : causes_of(*result_.rmse, target_, task_, method, occluders))
            result_.warnings.push_back(std::move(warning));
        if (std::string warning = coarse_faces_warning(target_, result_.values[Channel::ao], occluders_.rays());
            !warning.empty())
            result_.warnings.push_back(std::move(warning));
    }

    BakeTarget& target_;
    const BakeTask& task_;
    Surroundings& surroundings_;
    const BakeProgress& progress_;
    TargetOccluders occluders_;
    TargetResult result_;
    TargetSurfels surfels_;
    std::vector<std::uint32_t> sample_; // see rmse_on_sample()
    float last_voxel_ = GridOptions{}.largest_voxel;
};

}

TargetResult bake_target(BakeTarget& target, const BakeTask& task, Surroundings& surroundings,
                         const BakeProgress& progress) {
    return TargetBake(target, task, surroundings, progress).run();
}

}
