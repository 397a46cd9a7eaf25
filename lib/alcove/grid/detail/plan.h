/// Which levels a bake needs, and what they will take, before anything is allocated.
#pragma once

#include "alcove/grid/voxelize.h"

#include <cstddef>

namespace alcove {

struct LevelPlan {
    float voxel = 0.0f; ///< finest, unit space
    int levels = 1;
    float outer_band = 0.0f, inner_band = 0.0f;
    bool cluster = false;   ///< there are enough triangles for GridOptions::cluster to take effect
    double triangles = 0.0; ///< as triangles_voxelized() has it
    double bytes = 0.0;     ///< estimate of the peak while building
};

/// Of triangles, in the unit space of the mesh's own box.
struct SurfaceSize {
    double area = 0.0;
    double length = 0.0; ///< of the longest sides together: what needles are made of
};
SurfaceSize surface_size(const Mesh& mesh, std::span<const Triangle> triangles);

/// Cubes within which vertices become one where a surface is clustered, voxels.
inline constexpr double cluster_cell = 0.5;

/// How many triangles are voxelized after some are left out as GridOptions::cluster has it.
double triangles_voxelized(double area, std::size_t triangles, double voxel, const GridOptions& options);

/// The finest voxel that is taken where none is asked for, unit space, unless memory asks for a larger one.
float chosen_voxel(float radius, float largest_voxel);

/// The finest voxel whose grids and what builds them fit the memory limit, unit space; infinite where the triangles alone
/// do not.
double finest_voxel(const SurfaceSize& size, std::size_t triangles, const GridOptions& options);

/// Levels are added until the last band, less its outermost voxel, reaches the radius. Voxels are counted
/// from area / voxel², what long triangles are cut into from their lengths. A voxel of 0 is coarsened until it fits.
/// \throw LimitError if no voxel fits the limit; if one that was asked for needs more than it or more than 2^20 voxels
/// along the diagonal, naming the finest that fits.
LevelPlan plan_levels(const Mesh& mesh, std::span<const Triangle> triangles, const GridOptions& options);

/// \throw LimitError if more triangles are left of a clustered surface than were planned, and they do not fit the limit: of
/// many parts smaller than a voxel none is left out.
void check_clustered(const LevelPlan& plan, std::size_t triangles, const GridOptions& options);

}
