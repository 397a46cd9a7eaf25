/// What bake works on: a mesh to voxelize, a grid to mesh, or a mesh and the grid to use for it.
#pragma once

#include "voxelized.h"

namespace alcove::cli {

struct BakeInputRequest {
    std::string input, grid; ///< a mesh or grid; the grid to use instead of voxelizing, or empty
    float adaptivity = 0.0f;
    bool self = false; ///< each part by itself
};

/// Adds --grid, --adaptivity and --self.
void add_bake_input_options(CLI::App& verb, BakeInputRequest& request);

/// Without a stack where no grid is needed, and for parts, which each get their own. A grid that holds distances less far than the radius is
/// extended, with a warning. Puts `read` and `grid` into `seconds`. \throw UsageError for options that do not go
/// together, and what reading, meshing and voxelizing throw.
VoxelizedMesh read_bake_input(const BakeInputRequest& request, const GridRequest& grid, bool needs_grid,
                              const CommonOptions& common, nlohmann::ordered_json& seconds);

}
