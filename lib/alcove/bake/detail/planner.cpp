#include "alcove/bake/detail/planner.h"

#include "alcove/bake/detail/plan_table.h"
#include "alcove/grid/detail/plan.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

// Errors differ by a third from mesh to mesh, and then the rays that hold one by two or three times. Where many are planned, a
// third of them tell first how it is here: as often as not they are enough, or fewer than planned are.
constexpr int scouts_share = 3, fewest_of_scouts = 4;

// What bakes come to differs from what is expected of them by a factor whose logarithm has this deviation, as measured on
// meshes that the table never saw.
constexpr double spread = 0.3;

/// How likely something expected to come to `rmse` is to hold the error.
double chance(double rmse, double error) {
    return 0.5 * std::erfc(std::log(rmse / error) / (spread * std::sqrt(2.0)));
}

/// The table between its radii, and as at its ends beyond them.
template <std::size_t n>
double at_radius(const std::array<double, n>& values, float radius) {
    static_assert(n == plan_table::radii.size());
    const double r = std::log(std::min(radius, 1.0f));
    for (std::size_t i = 0; i + 1 < n; ++i) {
        const double low = std::log(plan_table::radii[i]), high = std::log(plan_table::radii[i + 1]);
        if (r < high) {
            const double t = std::clamp((r - low) / (high - low), 0.0, 1.0);
            return values[i] + t * (values[i + 1] - values[i]);
        }
    }
    return values[n - 1];
}

double ray_seconds(const PlanRequest& request) {
    const double doublings = std::log2(static_cast<double>(std::max<std::size_t>(request.triangles, 1)));
    const double relative =
        1.0 + plan_table::rays_slower_per_doubling * (doublings - plan_table::doublings_of_rays);
    return at_radius(plan_table::seconds_per_ray, request.radius) * std::max(relative, 0.3);
}

double grid_seconds(const PlanRequest& request, float largest_voxel) {
    const double voxel = chosen_voxel(request.radius, largest_voxel);
    const double voxelized = triangles_voxelized(request.area, request.triangles, voxel, {.cluster = true});
    const double cells = request.area / (voxel * voxel);
    return plan_table::seconds_per_grid + plan_table::grid_seconds_per_triangle * voxelized +
           plan_table::clustering_seconds_per_triangle *
               (static_cast<double>(request.triangles) - voxelized) +
           plan_table::grid_seconds_per_voxel * cells +
           plan_table::grid_seconds_of_both * std::sqrt(voxelized * cells);
}

}

Planner::Planner(const PlanRequest& request, const Pilot& pilot) : error_(request.error) {
    const auto surfels = static_cast<double>(request.surfels);
    const double tree = plan_table::tree_seconds_per_triangle * static_cast<double>(request.triangles);
    const int rays = pilot.rays_for(request.error, request.seed);
    candidates_.push_back(
        {{choose(find_method("exact"), rays), 0.0f, error_, tree + surfels * rays * ray_seconds(request)},
         0.0,
         tree});
    const auto rmse_of = [&](const plan_table::Row& row) {
        return at_radius(row.error_per_difficulty, request.radius) * std::max(pilot.difficulty(), 1e-6);
    };
    const auto add = [&](const plan_table::Row& row, int samples, double rmse, double seconds_per_surfel) {
        const bool there = request.has_grid
                               ? row.largest_voxel == GridOptions{}.largest_voxel
                               : chosen_voxel(request.radius, row.largest_voxel) >= request.finest_voxel;
        if (!there)
            return;
        const MethodChoice choice = choose(find_method(row.method), samples);
        if (!(request.wanted & Exact::gives).without(choice.method->gives).empty())
            return;
        const double grid = request.has_grid ? 0.0 : grid_seconds(request, row.largest_voxel);
        const double own = choice.rays() * ray_seconds(request) + seconds_per_surfel;
        const double of_tree = choice.method->needs_mesh ? tree : 0.0;
        candidates_.push_back(
            {{choice, row.largest_voxel, rmse, grid + of_tree + surfels * own}, grid, of_tree});
    };
    const double target = 0.95 * error_;
    for (std::size_t i = 0; i < plan_table::rows.size(); ++i) {
        const plan_table::Row& row = plan_table::rows[i];
        add(row, row.samples, rmse_of(row), row.seconds_per_surfel);
        if (i == 0 || !find_method(row.method).needs_mesh)
            continue;
        // Between two counts of rays, that which is expected to be a little under the wanted error.
        const plan_table::Row& fewer = plan_table::rows[i - 1];
        if (fewer.method == row.method && fewer.largest_voxel == row.largest_voxel && rmse_of(row) < target &&
            target < rmse_of(fewer)) {
            const double way = std::log(target / rmse_of(fewer)) / std::log(rmse_of(row) / rmse_of(fewer));
            const auto samples = static_cast<int>(
                std::ceil(fewer.samples * std::pow(double(row.samples) / fewer.samples, way)));
            if (samples < row.samples)
                add(row, samples, target,
                    fewer.seconds_per_surfel + way * (row.seconds_per_surfel - fewer.seconds_per_surfel));
        }
    }
}

Plan Planner::next() const {
    const Candidate* best = &candidates_.front();
    for (const Candidate& candidate : candidates_)
        if (!candidate.tried && candidate.plan.rmse <= error_ && candidate.plan.seconds < best->plan.seconds)
            best = &candidate;
    return scout_of(hope_of(*best)).plan;
}

bool Planner::is_known(const Method* method) const {
    return std::any_of(candidates_.begin(), candidates_.end(), [&](const Candidate& candidate) {
        return candidate.tried && candidate.plan.choice.method == method;
    });
}

/// What saves most time on the average where it is tried first: that itself where nothing does.
const Planner::Candidate& Planner::hope_of(const Candidate& planned) const {
    const Candidate* hope = &planned;
    double saved = 0.0;
    for (const Candidate& other : candidates_) {
        if (is_known(other.plan.choice.method))
            continue;
        const bool same_grid = other.plan.largest_voxel == planned.plan.largest_voxel,
                   same_tree = other.plan.choice.method->needs_mesh && planned.plan.choice.method->needs_mesh;
        const double in_vain = other.plan.seconds - (same_grid ? other.grid_seconds : 0.0) -
                               (same_tree ? other.tree_seconds : 0.0);
        const double saves = chance(other.plan.rmse, error_) * planned.plan.seconds - in_vain;
        if (other.plan.seconds < planned.plan.seconds && saves > saved) {
            hope = &other;
            saved = saves;
        }
    }
    return *hope;
}

/// Of the same method, with a share of its rays.
const Planner::Candidate& Planner::scout_of(const Candidate& planned) const {
    const auto alike = [&](const Candidate& other) {
        return other.plan.choice.method == planned.plan.choice.method;
    };
    const int rays = planned.plan.choice.rays() / scouts_share;
    if (planned.plan.largest_voxel == 0.0f || is_known(planned.plan.choice.method) || rays < fewest_of_scouts)
        return planned;
    const Candidate* scout = &planned;
    for (const Candidate& other : candidates_)
        if (alike(other) && other.plan.largest_voxel == planned.plan.largest_voxel &&
            other.plan.choice.rays() <= rays &&
            (scout == &planned || other.plan.choice.rays() > scout->plan.choice.rays()))
            scout = &other;
    return *scout;
}

void Planner::learn(const Plan& tried, double rmse) {
    const double correction = rmse / std::max(tried.rmse, 1e-9);
    for (Candidate& candidate : candidates_) {
        Plan& plan = candidate.plan;
        if (plan.choice == tried.choice && plan.largest_voxel == tried.largest_voxel)
            candidate.tried = true;
        if (plan.choice.method == tried.choice.method && plan.largest_voxel > 0.0f)
            plan.rmse *= correction;
        // Its grid is there now.
        if (plan.largest_voxel == tried.largest_voxel && plan.largest_voxel > 0.0f) {
            plan.seconds -= candidate.grid_seconds;
            candidate.grid_seconds = 0.0;
        }
        if (tried.choice.method->needs_mesh) {
            plan.seconds -= candidate.tree_seconds;
            candidate.tree_seconds = 0.0;
        }
    }
}

void Planner::leave_out(float largest_voxel) {
    std::erase_if(candidates_,
                  [&](const Candidate& candidate) { return candidate.plan.largest_voxel == largest_voxel; });
}

}
