/// What an estimator costs on a mesh, and how far it is from exact rays.
///
///     const MeasuredMesh mesh("dragon.ply", read_mesh("dragon.ply"));
///     const Truth truth = make_truth(mesh, 0.1f);
///     const MeasuredGrid grid = build_grid(mesh, 0.1f, 0.0f);
///     const Measurement m = measure(mesh, truth, &grid, choose(find_method("classic")));
///
/// Seconds are those of the process's CPU clock, all threads together, of a single pass; so nothing else may
/// run in the process meanwhile, and no two of these functions at a time.
#pragma once

#include "alcove/bake/error_figures.h"
#include "alcove/field/level_stack.h"
#include "alcove/mesh/mesh.h"
#include "alcove/occlusion/catalog.h"

namespace alcove {

/// A mesh with all that every method on it shares.
struct MeasuredMesh {
    /// \throw InputError where no vertex has a normal; what RaySurface throws.
    MeasuredMesh(std::string name, Mesh mesh);

    std::string name;
    Mesh mesh;
    std::vector<Triangle> triangles;
    Frame frame;
    std::vector<Surfel> surfels;
    std::vector<std::uint32_t> order; ///< spatial_order() of the surfels
    double tree_seconds = 0.0;        ///< of building `rays`
    RaySurface rays;

  private:
    RaySurface make_rays();
};

struct TruthOptions {
    int rays = 1024;           ///< a vertex, >= 1; their own error is about 0.003
    std::size_t most = 20'000; ///< vertices, >= 1
};

/// The reference ao of some vertices: exact rays, of another seed than a bake's.
struct Truth {
    float radius = 0.0f; ///< unit space; may be infinite
    std::vector<std::uint32_t>
        vertices;          ///< all that have a normal, or evenly chosen ones along the Morton curve
    std::vector<float> ao; ///< one each
};
Truth make_truth(const MeasuredMesh& mesh, float radius, const TruthOptions& options = {},
                 const Progress& progress = {});

/// A field, made once for all methods that probe it.
struct MeasuredGrid {
    LevelStack field;
    float asked_voxel;                ///< unit space; 0 where it was chosen
    std::size_t active_voxels, bytes; ///< of all levels
    double seconds;                   ///< of voxelizing and reading the grids
    std::size_t peak_rss_bytes;       ///< meanwhile
};

/// Radius and voxel in unit space; a voxel of 0 is chosen, and dense surfaces are clustered, as in a bake.
/// \throw as voxelize().
MeasuredGrid build_grid(const MeasuredMesh& mesh, float radius, float voxel, const Progress& progress = {});

struct Measurement {
    std::string mesh, method;
    int samples = 0; ///< as of MethodChoice
    std::size_t vertices = 0, triangles = 0;
    float radius = 0.0f;      ///< unit space; may be infinite
    float voxel = 0.0f;       ///< finest, unit space; 0 where no grid was asked
    float asked_voxel = 0.0f; ///< unit space; 0 where it was chosen
    std::size_t levels = 0, active_voxels = 0;
    ErrorFigures error;
    double grid_seconds = 0.0;      ///< 0 where no grid was asked
    double tree_seconds = 0.0;      ///< of the triangles' hierarchy; 0 where no ray was asked
    double occlusion_seconds = 0.0; ///< of all vertices
    double map_calls = 0.0;         ///< a vertex, counted on at most 1,024 of them
    double rays = 0.0;              ///< a vertex, through the grid or at the mesh
    std::size_t grid_bytes = 0;
    std::size_t peak_rss_bytes = 0; ///< of the process while grid and occlusion were made; 0 where unknown
    std::string picture;            ///< the error painted on the mesh, as a data URI; may be empty

    double seconds() const { return grid_seconds + tree_seconds + occlusion_seconds; }
    std::string label() const; ///< "guided:3", "multiscale"
};

enum class Pictures : bool { none, painted };

/// Bakes all vertices and compares those of the truth, at its radius. `grid` may be null for a method that
/// asks none. \throw what the method throws.
Measurement measure(const MeasuredMesh& mesh, const Truth& truth, const MeasuredGrid* grid,
                    const MethodChoice& choice, Pictures pictures = Pictures::none,
                    const Progress& progress = {});

}
