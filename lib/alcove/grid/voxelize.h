/// Turns a mesh into narrow-band level sets.
#pragma once

#include "alcove/grid/grid_stack.h"
#include "alcove/grid/plan.h"
#include "alcove/mesh/mesh.h"

#include <functional>

namespace alcove {

enum class SignChoice {
    automatic, ///< solid where the mesh is closed, oriented outward and hides no part in another, else sheet
    solid,
    sheet,
};

struct VoxelizeOptions {
    GridOptions grid;
    SignChoice sign = SignChoice::automatic;
    /// Told how much of the work is done, in [0, 1], a few times. Called on the calling thread.
    std::function<void(double done)> progress = {};
};

/// Voxelizes in index space, recentred and scaled in double precision, so neither the size of the scene nor
/// its place matter. Distances are exact but for rounding, to the nearest triangle; solids are where the winding
/// number is 1 or more. A tree of the triangles is built once and searched for each level where the finer one does
/// not know the distance, so only the first step touches every triangle. The result does not depend on the number
/// of threads.
///
/// \throw InputError if no triangle has an area; LimitError as plan_levels().
GridStack voxelize(const Mesh& mesh, std::span<const Triangle> triangles,
                   const VoxelizeOptions& options = {});

}
