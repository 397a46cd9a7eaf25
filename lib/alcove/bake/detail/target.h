/// Bakes one surface: a whole mesh, a connected part of it, or points on it.
#pragma once

#include "alcove/bake/bake.h"
#include "alcove/bake/detail/deadline.h"
#include "alcove/bake/detail/pilot.h"
#include "alcove/bake/detail/surroundings.h"
#include "alcove/occlusion/catalog.h"
#include "alcove/occlusion/detail/contacts.h"

namespace alcove {

/// Settings that all targets of a bake share.
struct BakeTask {
    const Method* method = nullptr;       ///< null: the planner chooses
    Settings settings{};                  ///< of `method`; the radius comes from the target
    std::optional<double> target_error{}; ///< RMSE to meet; empty if the settings are fixed
    std::optional<double> error{};        ///< RMSE to plan for, at most target_error
    ChannelSet attributes = Channel::ao;
    Via via = Via::grid;
    std::uint32_t seed = 0;
    bool pilot = true;
    bool keep_grid = false;
    Deadline deadline{std::nullopt};
};

struct BakeTarget {
    const Mesh& mesh;
    std::vector<Triangle> triangles;
    Frame frame;
    std::vector<Surfel> surfels;
    float radius;                    ///< unit space; may be infinite
    VoxelizeOptions voxelizing;      ///< unit space
    const GridStack* grid = nullptr; ///< in the same frame; used instead of voxelizing
    /// Largest voxel of the grids of occluders, scene units. 0: chosen automatically; empty: the voxel of the target's
    /// own grid.
    std::optional<double> occluder_voxel{};
    PilotOptions pilot_share{}; ///< only the member `surfels` is used, as the maximum for this target
    double share = 1.0;         ///< the share that this target has of all surfels of the bake
    IsOwnFace is_own_face = uses_vertex;
    /// If set, is called with the ao of all surfels so far and returns further surfels, whose values are appended,
    /// until it returns none. For is_own_face, the indices of the surfels from one call follow those of `surfels`.
    std::function<std::vector<Surfel>(std::span<const float> ao)> more{};
};

struct TargetResult {
    ChannelValues values; ///< lengths in the target's unit space
    MethodChoice choice;
    double evaluated = 1.0; ///< see Baked::evaluated
    std::string reason;     ///< see Baked::reason
    std::optional<double> rmse{};
    GridSummary grid;
    GridStack stack; ///< only if BakeTask::keep_grid
    BakeSeconds seconds;
    std::vector<std::string> warnings;
};

/// Bakes with the method of the task or with the cheapest plan. If the pilot measures an RMSE above the one to meet,
/// makes another plan and bakes again. Also finds the contacts of the surfels. \throw like bake()
TargetResult bake_target(BakeTarget& target, const BakeTask& task, Surroundings& surroundings,
                         const BakeProgress& progress);

}
