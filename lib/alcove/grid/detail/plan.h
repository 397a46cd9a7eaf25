/// Plans the levels that a bake needs and estimates their memory before anything is allocated.
#pragma once

#include "alcove/grid/voxelize.h"

#include <cstddef>

namespace alcove {

struct LevelPlan {
    float voxel = 0.0f; ///< finest, unit space
    int levels = 1;
    float outer_band = 0.0f, inner_band = 0.0f;
    bool cluster = false;     ///< whether GridOptions::cluster is set and there are enough triangles for it
    double triangles = 0.0;   ///< see triangles_voxelized()
    double bytes = 0.0;       ///< estimated peak while building
    double spare_bytes = 0.0; ///< left of the memory limit
};

/// Total size of a set of triangles, in the unit space of the mesh's own box.
struct SurfaceSize {
    double area = 0.0;
    double length = 0.0; ///< sum of the longest sides, which measures needles
};
SurfaceSize surface_size(const Mesh& mesh, std::span<const Triangle> triangles);
/// The same if the frame of the mesh's box is known.
SurfaceSize surface_size(const Mesh& mesh, std::span<const Triangle> triangles, const Frame& frame);

/// Measured peak of resident memory per voxelized triangle, in the search for nearest triangles (130 for solids, 230
/// for sheets).
inline constexpr double bytes_per_triangle = 240.0;

/// Side of the cubes within which clustering merges vertices, in voxels.
inline constexpr double cluster_cell = 0.5;

/// Estimated number of triangles to voxelize, after clustering if GridOptions::cluster applies. `area` and `voxel`
/// are in unit space.
double triangles_voxelized(double area, std::size_t triangles, double voxel, const GridOptions& options);

/// The default finest voxel before the memory limit is applied, unit space.
float chosen_voxel(float radius, float largest_voxel);

/// The finest voxel size, in unit space, at which the grids can be built within the memory limit; infinite if the
/// triangles alone exceed it.
double finest_voxel(const SurfaceSize& size, std::size_t triangles, const GridOptions& options);

/// Adds levels until the last band, less its outermost voxel, reaches the radius. Estimates the voxels from area /
/// voxel² and the fragments of long triangles from their lengths. If GridOptions::voxel is 0, coarsens the default
/// voxel until the grids fit in memory.
/// \throw LimitError if no voxel fits the memory limit, or if the requested one does not fit or takes more than 2^20
/// voxels along the diagonal; the message then names the finest voxel that fits.
LevelPlan plan_levels(const Mesh& mesh, std::span<const Triangle> triangles, const GridOptions& options);
/// The same if the size of the triangles is known.
LevelPlan plan_levels(const SurfaceSize& size, std::size_t triangles, const GridOptions& options);

/// \throw LimitError if clustering left more triangles than planned, and these do not fit in the memory limit. This
/// happens with many parts smaller than a voxel, which clustering keeps.
void check_clustered(const LevelPlan& plan, std::size_t triangles, const GridOptions& options);

}
