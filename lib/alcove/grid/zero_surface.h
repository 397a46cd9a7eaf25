/// From grids back to the surface: its mesh, and what a grid's band is too thin to hold.
#pragma once

#include "alcove/grid/grid_stack.h"
#include "alcove/mesh/mesh.h"

#include <functional>
#include <span>

namespace alcove {

/// The zero surface of the finest level in scene units, faces outward: quads, and where an `adaptivity` in
/// [0, 1] above 0 merges flat neighbourhoods, triangles too. By OpenVDB's volumeToMesh, after T. Ju et al.,
/// "Dual contouring of Hermite data" (2002). A band that ends at the surface leaves a hole there.
/// \throw InputError if no distance changes its sign, or the stack is a sheet: the back of one is no zero
/// surface. Cost: linear in the active voxels.
Mesh mesh_zero_surface(const GridStack& stack, float adaptivity = 0.0f);

/// Answers the distances of points, in their unit.
using Sampler = std::function<void(std::span<const Vec3> points, float* distances)>;

/// The same of what a function says of the cube of side 1 around the origin, on voxels of that edge; what is further
/// outside is left out. It is asked once for every 8³ voxels, and for each voxel of those that it says are near the
/// surface. \throw InputError if there is no surface.
Mesh mesh_zero_surface(const Sampler& sample, float voxel);

/// Adds coarser levels, voxelized from the zero surface, until the last reaches `radius` (unit space; infinity
/// is cut to the diagonal). With `inside`, a stack that does not know the inside as far as the outside is
/// replaced by one of the same voxel that does, from the same surface. Gives back a stack that lacks nothing as
/// it is. \throw as mesh_zero_surface(), and LimitError as voxelize().
GridStack extend_levels(GridStack stack, float radius, bool inside = false);

}
