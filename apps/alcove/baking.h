/// The second half of bake: from a mesh and what stands around it to values.
#pragma once

#include "planning.h"
#include "surroundings.h"

#include "alcove/mesh/normals.h"
#include "alcove/occlusion/catalog.h"

#include <functional>

namespace alcove::cli {

/// What to bake, as the command line has it.
struct BakeTask {
    const Method* method = nullptr; ///< null where it is planned
    Settings settings{};
    ChannelSet wanted{};
    NormalSource normals = NormalSource::automatic;
    PlanningRequest planning{};
    std::uint32_t seed = 0; ///< of a plan; else it is among the settings

    /// What the method asks, or what is asked whatever the plan; the pilot's triangles are not among it.
    Needs needs() const;
};

struct Baked {
    MethodChoice choice;
    ChannelValues values;         ///< of the vertices of the mesh, lengths in its unit space
    GridFacts grid;               ///< of parts: the coarsest voxel, the most levels and bytes
    std::optional<double> rmse{}; ///< as the pilot tells; none without one
    double grid_seconds = 0.0, pilot_seconds = 0.0; ///< of the time it took
};

/// What to say where an RMSE of more than 0.03 may come from walls that the grid is too coarse for; else empty, and where
/// the method traces no rays, or triangles. `diagonal` of the mesh, scene units. `finest_voxel` tells which voxels may be
/// asked for, unit space: those that are not finer. It is called where there is something to say.
std::string thin_wall_warning(double rmse, const Method& method, std::span<const Surfel> surfels,
                              const Occluders& occluders, double diagonal,
                              const std::function<double()>& finest_voxel);

/// The mesh as a whole, by the method of the task.
Baked bake_whole(VoxelizedMesh& input, const Surroundings& surroundings, const BakeTask& task,
                 std::span<const Surfel> surfels, const Progress& progress);

/// The same by the cheapest method that holds the error. Without a stack in `input` one is made where the plan
/// asks for it, and grids of the surroundings with it.
Baked bake_by_plan(VoxelizedMesh& input, Surroundings& surroundings, const BakeTask& task,
                   std::span<const Surfel> surfels, const CommonOptions& common, const Progress& progress);

/// Every connected part as if it were alone, one after the other, each in its own unit space with the voxel a
/// bake of it alone would choose, or the one that was asked for, but at most 1/32 of the part.
Baked bake_parts(VoxelizedMesh& input, const Surroundings& surroundings, const BakeTask& task,
                 const Progress& progress);

}
