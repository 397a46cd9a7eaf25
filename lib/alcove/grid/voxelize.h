/// Turns a mesh into narrow-band level sets.
#pragma once

#include "alcove/grid/grid_stack.h"
#include "alcove/mesh/mesh.h"

#include <functional>

namespace alcove {

struct GridOptions {
    /// Largest distance from the surface that is asked for, unit space, > 0; infinity is cut to the diagonal.
    float radius = 0.1f;
    /// Edge of the finest voxel, unit space; 0 chooses `largest_voxel`, or radius/8 where that is finer, down
    /// to 1/1024.
    float voxel = 0.0f;
    /// What a chosen voxel is at most, unit space, > 0, unless memory asks for more.
    float largest_voxel = 1.0f / 256.0f;
    /// Voxels outward from the surface on every level, at least 3: map() is right up to one less.
    float outer_band = 5.0f;
    /// Voxels inward on every level of a solid, at least 2. Occlusion never looks deeper.
    float inner_band = 2.0f;
    /// Where triangles are far smaller than voxels, the grids are of fewer that lie near them: a few hundredths of a voxel
    /// away as a rule, √3 voxels at most.
    bool cluster = false;
    /// Bytes that grids and what builds them may take.
    double memory_limit = 4.0 * (1u << 30);
};

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
