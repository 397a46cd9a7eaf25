/// Converts a mesh to narrow-band level sets.
#pragma once

#include "alcove/grid/grid_stack.h"
#include "alcove/mesh/mesh.h"

#include <functional>
#include <limits>
#include <optional>
#include <span>

namespace alcove {

struct GridOptions {
    /// Largest distance from the surface that will be queried, unit space, > 0; infinity is clamped to the diagonal.
    float radius = 0.1f;
    /// Edge of the finest voxel, unit space. 0 chooses radius/8, but at least 1/1024, and at most `largest_voxel`.
    float voxel = 0.0f;
    /// Sets the finest voxel instead of `voxel`, and puts all voxel centres on the lattice.
    std::optional<Lattice> lattice{};
    /// Upper limit of an automatic voxel, unit space, > 0; the memory limit may still require a larger one.
    float largest_voxel = 1.0f / 256.0f;
    /// Outer band width of every level, voxels, at least 3. map() is correct up to one voxel less.
    float outer_band = 5.0f;
    /// Inner band width of every level of a solid, voxels, at least 2. Occlusion never samples deeper.
    float inner_band = 2.0f;
    /// If the voxel is automatic, add partial levels near walls and gaps thinner than two voxels (GridStack::partial).
    bool refine = true;
    /// Where triangles are far smaller than voxels, voxelize a surface with fewer triangles: usually a few
    /// hundredths of a voxel away from the original, √3 voxels at most.
    bool cluster = false;
    /// Limit of the memory for the grids and for building them, bytes. The limit of the process, by default half of the
    /// memory of the machine, applies too.
    double memory_limit = std::numeric_limits<double>::infinity();
};

enum class SignChoice {
    automatic, ///< solid if the mesh is closed, oriented outward and has no part hidden in another, else sheet
    solid,
    sheet,
};

struct VoxelizeOptions {
    GridOptions grid;
    SignChoice sign = SignChoice::automatic;
    bool warns_of_faces = true; ///< about flipped or inward faces; of little use for a reconstructed surface
    /// Called a few times with the share of the work that is done, in [0, 1], on the calling thread.
    std::function<void(double done)> progress = {};
};

/// Voxelizes in index space, recentred and scaled in double precision, so neither the size nor the position of the
/// scene affects precision. Distances are to the nearest triangle, exact up to rounding; a point is inside a solid
/// if the winding number is 1 or more. The tree of triangles is built once and searched on each level only where
/// the finer level has no distance, so only the first step touches every triangle. The result does not depend on
/// the number of threads. With a lattice, the voxels of the level of stride 2^n are those whose lattice indices are
/// multiples of 2^n, so that equal levels of different meshes match.
///
/// \throw InputError if no triangle has nonzero area, or if the mesh is more than 2^30 voxels from the origin of the
/// lattice; LimitError as plan_levels().
GridStack voxelize(const Mesh& mesh, std::span<const Triangle> triangles, const VoxelizeOptions& options = {});

/// The sign that voxelize() chooses by default. Cost: about 10 ns per triangle. \throw LimitError as voxelize().
Sign sign_of(const Mesh& mesh, std::span<const Triangle> triangles);

/// Meshes the zero isosurface of the finest level in scene units, with faces outward: quads, and triangles too if
/// `adaptivity`, in [0, 1], is above 0 and merges flat regions. Uses OpenVDB's volumeToMesh, which is based on dual
/// contouring (Ju et al. 2002). The mesh has a hole where the band ends at the surface.
/// \throw InputError if no distance changes sign, or if the stack is a sheet, whose back is not a zero isosurface.
/// Cost: linear in the active voxels.
Mesh mesh_zero_surface(const GridStack& stack, float adaptivity = 0.0f);

/// Writes the signed distance of each point, in the unit of the points.
using Sampler = std::function<void(std::span<const Vec3> points, float* distances)>;

/// Meshes the zero isosurface of a distance function within the cube of side 1 around the origin, on voxels of edge
/// `voxel`, and ignores what is outside. Samples the centre of each block of 8³ voxels, then each voxel of the
/// blocks near the surface. \throw InputError if there is no surface.
Mesh mesh_zero_surface(const Sampler& sample, float voxel);

struct PointOptions {
    std::optional<Length> point_size{}; ///< distance between neighbouring points; empty: measured
    /// Smallest useful voxel of the reconstruction, unit space; clamped to between 0.9 and 3 times the point size.
    float least_voxel = 0.0f;
};

/// The surface of points.
struct PointSurface {
    Mesh mesh; ///< triangles; Mesh::warnings counts points that were left out and normals that were estimated
    /// The points projected onto the surface, scene units, and their normals. Normals are zero for outliers, for points
    /// that are not finite, and where there is no surface.
    std::vector<Vec3d> positions;
    std::vector<Vec3> normals;
    std::vector<std::uint32_t> faces; ///< on which they lie
};

/// Reconstructs the surface of a mesh without faces, whose vertices are points of a scan, with or without normals.
/// Holes of up to about twice the point size are closed, and larger ones stay open. Outliers are left out. Missing
/// normals are estimated. Cost: 2 to 4 µs per point on one thread. \throw InputError if the points are too few, or no
/// surface is found; LimitError if it exceeds the memory limit.
PointSurface surface_of_points(const Mesh& points, const PointOptions& options = {});

/// The mesh itself, or if it has no faces, the surface of its points.
Mesh with_surface(Mesh mesh, const PointOptions& options = {});

/// Adds coarser levels, voxelized from the zero isosurface, until the last reaches `radius` (unit space; infinity is
/// clamped to the diagonal). With `inside`, replaces a stack for which knows_inside() is false by one of the same
/// voxel and surface for which it is true. Returns a stack that already satisfies both unchanged. \throw like
/// mesh_zero_surface(), and LimitError like voxelize().
GridStack extend_levels(GridStack stack, float radius, bool inside = false);

}
