/// The cheapest way to a wanted error.
#pragma once

#include "alcove/bake/detail/pilot.h"
#include "alcove/occlusion/catalog.h"

#include <vector>

namespace alcove {

struct PlanRequest {
    double error = 0.02; ///< RMSE to hold, > 0
    float radius = 0.1f; ///< unit space; may be infinite
    std::uint32_t seed = 0;
    std::size_t surfels = 0, triangles = 0;
    double area = 0.0; ///< of the triangles, unit space
    /// No grid is finer, unit space, as finest_voxel() in grid/plan.h has it.
    double finest_voxel = 0.0;
    bool has_grid = false; ///< one of GridOptions' own voxel is there in any case, at no cost
    ChannelSet wanted = Channel::ao;
};

/// A method with what it needs, and what it is expected to come to.
struct Plan {
    MethodChoice choice;
    float largest_voxel = 0.0f; ///< of its grid, as GridOptions has it; 0 for none
    double rmse = 0.0;
    double seconds = 0.0; ///< CPU seconds of grid, tree and occlusion on the machine of the table
};

/// Weighs exact rays, whose number the pilot tells, against guided and calibrated, as far as they give the wanted
/// channels that exact rays give. Their errors and costs are in plan_table.h: measured on the meshes that
/// calibrated was fitted to, errors in units of Pilot::difficulty(), medians over the meshes. Counts of
/// rays between those of the table are reckoned from both. What a bake turned out to be corrects the others of its
/// method. The plan depends on the mesh alone, not on the speed of the machine. Not thread-safe.
class Planner {
  public:
    Planner(const PlanRequest& request, const Pilot& pilot);

    /// The cheapest that is expected to hold the error and was not tried; exact rays always are. Before it, of methods that
    /// were not tried yet, one that may hold the error and is so cheap that this saves time on the average; before many
    /// rays of guided a few.
    Plan next() const;
    /// Tells what a plan came to: where that is over the error, next() is another.
    void learn(const Plan& tried, double rmse);
    /// There is no such grid.
    void leave_out(float largest_voxel);

  private:
    struct Candidate {
        Plan plan;
        double grid_seconds, tree_seconds; ///< of those, what is not there yet
        bool tried = false;
    };
    const Candidate& hope_of(const Candidate& planned) const;
    const Candidate& scout_of(const Candidate& planned) const;
    bool is_known(const Method* method) const; ///< one of its bakes was tried

    double error_;
    std::vector<Candidate> candidates_;
};

}
