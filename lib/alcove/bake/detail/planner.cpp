#include "alcove/bake/detail/planner.h"

#include "alcove/bake/detail/plan_table.h"
#include "alcove/base/types.h"
#include "alcove/grid/detail/plan.h"
#include "alcove/occlusion/methods/calibrated.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

// Errors vary by a third between meshes, so the number of rays that meets an error varies by a factor of two or three.
// If many rays are planned, a third of them are tried first. About half the time, these are enough, or they show that
// fewer rays than planned are enough.
constexpr int share_of_first_trial = 3, min_rays_of_trial = 4;

// Standard deviation of log(measured / expected error) on meshes other than those on which the table was measured.
constexpr double spread = 0.3;

// With Via::grid, the field is too expensive if it costs this many times as much as exact, and also
// PlanRequest::allowed_seconds more.
constexpr double allowed_ratio = 1.5;

/// The probability that a plan with the expected error `rmse` meets `error`.
double chance(double rmse, double error) {
    return 0.5 * std::erfc(std::log(rmse / error) / (spread * std::sqrt(2.0)));
}

/// Interpolates the values of the table between its radii. The result is constant beyond the first and the last radius.
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
    const double relative = 1.0 + plan_table::rays_slower_per_doubling * (doublings - plan_table::doublings_of_rays);
    return at_radius(plan_table::seconds_per_ray, request.radius) * std::max(relative, 0.3);
}

double tree_seconds(const PlanRequest& request) {
    return plan_table::tree_seconds_per_triangle * static_cast<double>(request.triangles);
}

/// Whether the voxel that is chosen by default exceeds half the radius.
bool is_too_coarse(const PlanRequest& request) {
    return !request.method && 2.0f * chosen_voxel(request.radius, GridOptions{}.largest_voxel) > request.radius;
}

double grid_seconds(const PlanRequest& request, float largest_voxel) {
    const double voxel = chosen_voxel(request.radius, largest_voxel);
    const double voxelized = triangles_voxelized(request.area, request.triangles, voxel, {.cluster = true});
    const double cells = request.area / (voxel * voxel);
    return plan_table::seconds_per_grid + plan_table::grid_seconds_per_triangle * voxelized +
           plan_table::clustering_seconds_per_triangle * (static_cast<double>(request.triangles) - voxelized) +
           plan_table::grid_seconds_per_voxel * cells + plan_table::grid_seconds_of_both * std::sqrt(voxelized * cells);
}

}

Planner::Planner(const PlanRequest& request, const Pilot& pilot)
    : error_(request.error), avoids_exact_(request.via == Via::grid && !request.method),
      allowed_seconds_(request.allowed_seconds), too_coarse_(is_too_coarse(request)) {
    const int rays = request.exact_rays > 0 ? request.exact_rays : pilot.rays_for(request.error, request.seed);
    const bool only_exact = request.method ? request.method == &find_method("exact") : request.via == Via::mesh;
    if (!request.method || only_exact)
        add_exact(request, rays);
    if (!only_exact)
        add_methods_of_field(request, pilot, rays);
    if (request.method)
        std::erase_if(candidates_,
                      [&](const Candidate& candidate) { return candidate.plan.choice.method != request.method; });
}

void Planner::add_exact(const PlanRequest& request, int rays) {
    rays = std::max(rays, request.min_rays);
    const double tree = tree_seconds(request);
    const double seconds = tree + static_cast<double>(request.surfels) * rays * ray_seconds(request);
    fallback_.push_back({{choose(find_method("exact"), rays), 0.0f, error_, seconds}, 0.0, tree, false});
}

/// Adds a plan that uses the field and computes its seconds. Does nothing if its grid is impossible or the method lacks
/// a wanted channel.
void Planner::add(const PlanRequest& request, Plan plan, double seconds_per_surfel, bool is_bound) {
    const Method& method = *plan.choice.method;
    if (method.samples_are == SampleKind::rays)
        plan.choice = choose(method, std::max(plan.choice.rays(), request.min_rays));
    const float voxel = chosen_voxel(request.radius, plan.largest_voxel);
    if (method.name == Calibrated::name && plan.rmse > request.max_rmse_of_calibrated)
        return;
    const bool is_possible = request.has_grid ? plan.largest_voxel == GridOptions{}.largest_voxel
                                              : voxel >= request.finest_voxel && !is_too_coarse(request);
    if (!is_possible || !(request.wanted & Exact::gives).without(method.gives).empty())
        return;
    const double grid = request.has_grid ? 0.0 : grid_seconds(request, plan.largest_voxel);
    const double tree = method.needs_mesh ? tree_seconds(request) : 0.0;
    const double per_surfel = plan.choice.rays() * ray_seconds(request) + seconds_per_surfel;
    const double at_contacts =
        method.name == Calibrated::name ? Calibrated::rays_at_contacts * ray_seconds(request) : 0.0;
    plan.seconds = grid + tree + static_cast<double>(request.surfels) * per_surfel +
                   static_cast<double>(request.contacts) * at_contacts;
    candidates_.push_back({plan, grid, tree, is_bound});
}

void Planner::add_methods_of_field(const PlanRequest& request, const Pilot& pilot, int exact_rays) {
    const auto rmse_of = [&](const plan_table::Row& row) {
        return at_radius(row.error_per_difficulty, request.radius) * std::max(pilot.difficulty(), 1e-6);
    };
    const auto plan_of = [&](const plan_table::Row& row, int samples, double rmse) {
        return Plan{choose(find_method(row.method), samples), row.largest_voxel, rmse};
    };
    const auto same_series = [](const plan_table::Row& a, const plan_table::Row& b) {
        return a.method == b.method && a.largest_voxel == b.largest_voxel;
    };
    const double target = 0.95 * error_;
    constexpr auto& rows = plan_table::rows;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const plan_table::Row& row = rows[i];
        add(request, plan_of(row, row.samples, rmse_of(row)), row.seconds_per_surfel);
        if (!find_method(row.method).needs_mesh)
            continue;
        // Add a ray count between two of the table, whose expected error is slightly below the wanted one.
        if (i > 0 && same_series(rows[i - 1], row) && rmse_of(row) < target && target < rmse_of(rows[i - 1])) {
            const plan_table::Row& fewer = rows[i - 1];
            const double way = std::log(target / rmse_of(fewer)) / std::log(rmse_of(row) / rmse_of(fewer));
            const auto samples =
                static_cast<int>(std::ceil(fewer.samples * std::pow(double(row.samples) / fewer.samples, way)));
            if (samples < row.samples)
                add(request, plan_of(row, samples, target),
                    fewer.seconds_per_surfel + way * (row.seconds_per_surfel - fewer.seconds_per_surfel));
        }
        // Guided converges to exact: with as many rays, its error is hardly larger than that of exact, whatever the
        // table says.
        if (i + 1 == rows.size() || !same_series(row, rows[i + 1]))
            for (const double more : {1.0, 1.3, 1.7, 2.25}) {
                const int samples = std::min(static_cast<int>(std::ceil(more * exact_rays)), Pilot::most_rays);
                add(request, plan_of(row, samples, std::pow(more, -Pilot::ray_exponent) * error_),
                    row.seconds_per_surfel, true);
            }
    }
}

/// The cheapest untried candidate that is expected to meet the error; null if there is none.
const Planner::Candidate* Planner::cheapest() const {
    const Candidate* best = nullptr;
    const auto look_at = [&](const std::vector<Candidate>& candidates) {
        for (const Candidate& candidate : candidates)
            if (!candidate.tried && candidate.plan.rmse <= error_ &&
                (!best || candidate.plan.seconds < best->plan.seconds))
                best = &candidate;
    };
    look_at(candidates_);
    if (!avoids_exact_)
        look_at(fallback_);
    return best;
}

Plan Planner::expected() const {
    const Candidate* best = cheapest();
    const auto exact = [&](std::string reason) {
        Plan plan = fallback_.front().plan;
        if (avoids_exact_)
            plan.reason = std::move(reason);
        return plan;
    };
    if (!best && !fallback_.empty())
        return exact(!candidates_.empty() ? "guided missed the error target with as many rays as exact needs"
                     : too_coarse_        ? "the finest voxel is larger than half the radius"
                                          : "no grid fits in memory");
    if (!best && candidates_.empty())
        throw LimitError("no grid for the named method fits in memory: leave out --method, or use --via mesh");
    if (!best) // the named method cannot meet the error: take its most accurate candidate
        best = &*std::min_element(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
            return a.tried != b.tried ? b.tried : a.plan.rmse < b.plan.rmse;
        });
    if (avoids_exact_ && !fallback_.empty() && best->plan.largest_voxel > 0.0f) {
        const double field = spent_ + best->plan.seconds, rays = fallback_.front().plan.seconds;
        if (field > allowed_ratio * rays && field > rays + allowed_seconds_)
            return exact(fmt::format("the field would cost about {:.2g} s, exact rays {:.2g} s", field, rays));
    }
    return best->plan;
}

Plan Planner::next() const {
    const Plan planned = expected();
    const auto is_planned = [&](const Candidate& candidate) {
        return candidate.plan.choice == planned.choice && candidate.plan.largest_voxel == planned.largest_voxel;
    };
    const auto found = std::find_if(candidates_.begin(), candidates_.end(), is_planned);
    if (found != candidates_.end())
        return fewer_rays_before(cheap_trial_before(*found)).plan;
    // The plan is exact. If other methods are allowed, a cheaper one may also meet the error.
    return avoids_exact_ || fallback_.empty() ? planned : fewer_rays_before(cheap_trial_before(fallback_.front())).plan;
}

bool Planner::is_last(const Plan& plan) const {
    const auto other = [&](const Candidate& candidate) {
        return !candidate.tried &&
               !(candidate.plan.choice == plan.choice && candidate.plan.largest_voxel == plan.largest_voxel);
    };
    return plan.largest_voxel == 0.0f ||
           (fallback_.empty() && std::none_of(candidates_.begin(), candidates_.end(), other));
}

bool Planner::is_known(const Method* method) const {
    return std::any_of(candidates_.begin(), candidates_.end(), [&](const Candidate& candidate) {
        return candidate.tried && candidate.plan.choice.method == method;
    });
}

/// The candidate that saves the most time on average if it is tried before `planned`; `planned` if none does.
const Planner::Candidate& Planner::cheap_trial_before(const Candidate& planned) const {
    const Candidate* trial = &planned;
    double saved = 0.0;
    for (const Candidate& other : candidates_) {
        // A method that missed the error is tried again only if its corrected expected error is too large by little or
        // not at all.
        constexpr double little = 1.1;
        if (other.tried || (is_known(other.plan.choice.method) && other.plan.rmse > little * error_))
            continue;
        const bool same_grid = other.plan.largest_voxel == planned.plan.largest_voxel,
                   same_tree = other.plan.choice.method->needs_mesh && planned.plan.choice.method->needs_mesh;
        const double wasted =
            other.plan.seconds - (same_grid ? other.grid_seconds : 0.0) - (same_tree ? other.tree_seconds : 0.0);
        const double saves = chance(other.plan.rmse, error_) * planned.plan.seconds - wasted;
        if (other.plan.seconds < planned.plan.seconds && saves > saved) {
            trial = &other;
            saved = saves;
        }
    }
    return *trial;
}

/// A plan of the same method with fewer rays, if `planned` takes many rays and its method has no measured error yet;
/// else `planned`.
const Planner::Candidate& Planner::fewer_rays_before(const Candidate& planned) const {
    const int rays = planned.plan.choice.rays() / share_of_first_trial;
    if (planned.plan.largest_voxel == 0.0f || is_known(planned.plan.choice.method) || rays < min_rays_of_trial)
        return planned;
    const Candidate* trial = &planned;
    for (const Candidate& other : candidates_)
        if (other.plan.choice.method == planned.plan.choice.method &&
            other.plan.largest_voxel == planned.plan.largest_voxel && other.plan.choice.rays() <= rays &&
            (trial == &planned || other.plan.choice.rays() > trial->plan.choice.rays()))
            trial = &other;
    return *trial;
}

void Planner::update(const Plan& tried, double rmse, double share) {
    const auto is_tried = [&](const Candidate& candidate) {
        return candidate.plan.choice == tried.choice && candidate.plan.largest_voxel == tried.largest_voxel;
    };
    const auto found = std::find_if(candidates_.begin(), candidates_.end(), is_tried);
    const bool is_bound = found != candidates_.end() && found->is_bound;
    if (found != candidates_.end())
        spent_ += found->grid_seconds + found->tree_seconds +
                  share * (found->plan.seconds - found->grid_seconds - found->tree_seconds);
    const double correction = rmse / std::max(tried.rmse, 1e-9);
    for (Candidate& candidate : candidates_) {
        Plan& plan = candidate.plan;
        candidate.tried = candidate.tried || is_tried(candidate);
        // Correct table errors and bounds by exact rays separately: the table may be wrong about a mesh for which the
        // bounds are right.
        if (plan.choice.method == tried.choice.method && candidate.is_bound == is_bound)
            plan.rmse *= correction;
        if (plan.largest_voxel == tried.largest_voxel) { // its grid exists now
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
