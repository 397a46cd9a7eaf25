/// Chooses the fastest method that meets an error target.
#pragma once

#include "alcove/bake/bake.h"
#include "alcove/bake/detail/pilot.h"
#include "alcove/occlusion/catalog.h"

#include <limits>
#include <string>
#include <vector>

namespace alcove {

struct PlanRequest {
    double error = 0.02; ///< RMSE to meet, > 0
    float radius = 0.1f; ///< unit space; may be infinite
    Via via = Via::automatic;
    const Method* method = nullptr; ///< the only method to plan with: exact, guided or calibrated; null: any
    std::uint32_t seed = 0;
    int exact_rays = 0; ///< from Pilot::rays_for() for this error and seed; 0: not known yet
    int min_rays = 0;   ///< per surfel
    std::size_t surfels = 0;
    std::size_t contacts = 0; ///< surfels that touch other faces
    std::size_t triangles = 0;
    double area = 0.0; ///< total area of the triangles, unit space
    /// The finest voxel of a grid that fits in memory, unit space, from finest_voxel() in grid/detail/plan.h.
    double finest_voxel = 0.0;
    /// With Via::grid, exact is planned if the field costs over 50 % more than exact, and also over this many seconds
    /// more.
    double allowed_seconds = 0.3;
    bool has_grid = false; ///< a grid with the default GridOptions::largest_voxel exists anyway, at no extra cost
    ChannelSet wanted = Channel::ao;
    /// The largest expected RMSE of calibrated. Interpolation between surfels averages the noise of rays, but not the
    /// errors of calibrated.
    double max_rmse_of_calibrated = std::numeric_limits<double>::infinity();
};

/// A method and its grid, with their expected error and cost.
struct Plan {
    MethodChoice choice;
    float largest_voxel = 0.0f; ///< of the grid, as in GridOptions; 0: no grid
    double rmse = 0.0;          ///< expected
    double seconds = 0.0;       ///< expected CPU seconds of grid, BVH and occlusion on the machine of the table
    /// Why the method is exact despite Via::grid; else empty.
    std::string reason{};
};

/// Compares exact, with the number of rays from the pilot, with guided and calibrated, if these provide the wanted
/// channels. Errors and costs come from plan_table.h. They were measured on the meshes on which calibrated was trained;
/// the errors are medians over these meshes, in units of Pilot::difficulty(). Between the ray counts of the table,
/// errors and costs are interpolated. The measured error of a bake corrects the expected errors of its method.
///
/// With Via::grid, exact is planned only if the field would cost over 50 % and over 0.3 s more, if no grid fits in
/// memory, if the finest voxel is larger than half the radius, or if guided missed the error with as many rays as exact
/// needs. Plans do not depend on the speed of the machine. Not thread-safe.
class Planner {
  public:
    Planner(const PlanRequest& request, const Pilot& pilot);

    /// The cheapest untried plan that is expected to meet the error, or a trial to run before that plan. A trial is a
    /// plan that may miss the error, but is so cheap that running it first saves time on average. Either the method of
    /// the trial has no measured error yet, or its measured error suggests that the trial misses the target by at most
    /// a tenth. Where guided would need many rays, the trial is guided with a third of them. \throw LimitError if no
    /// grid for the named method fits in memory.
    Plan next() const;
    /// Like next(), but never a trial: the plan that is most likely to end the search.
    Plan expected() const;
    /// Whether no untried plan remains after this one.
    bool is_last(const Plan& plan) const;
    /// Takes the measured error of a plan into account. If the measured error exceeds the wanted one, next() then
    /// returns another plan. `share`: fraction of the surfels on which the plan was tried.
    void update(const Plan& tried, double rmse, double share = 1.0);
    /// Removes all plans with this grid, because it does not fit in memory.
    void leave_out(float largest_voxel);

  private:
    struct Candidate {
        Plan plan;
        double grid_seconds, tree_seconds; ///< of its grid and BVH; 0 if these exist
        bool is_bound;                     ///< whether its error was derived from that of exact rays
        bool tried = false;
    };
    void add_exact(const PlanRequest& request, int rays);
    void add(const PlanRequest& request, Plan plan, double seconds_per_surfel, bool is_bound = false);
    void add_methods_of_field(const PlanRequest& request, const Pilot& pilot, int exact_rays);
    const Candidate* cheapest() const;
    const Candidate& cheap_trial_before(const Candidate& planned) const;
    const Candidate& fewer_rays_before(const Candidate& planned) const;
    bool is_known(const Method* method) const; // whether a candidate with this method was tried

    double error_;
    double spent_ = 0.0; ///< predicted seconds of the plans tried in vain
    bool avoids_exact_;
    double allowed_seconds_;
    bool too_coarse_;                   // no voxel resolves the radius
    std::vector<Candidate> candidates_; // methods that use the field
    std::vector<Candidate> fallback_;   // exact, if allowed; the last resort with Via::grid
};

}
