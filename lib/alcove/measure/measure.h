/// Measures the cost of an estimator on a mesh and its error against exact rays.
///
///     const MeasuredMesh mesh("dragon.ply", read_mesh("dragon.ply"));
///     const Truth truth = make_truth(mesh, 0.1f);
///     const MeasuredGrid grid = build_grid(mesh, 0.1f, 0.0f);
///     const Measurement m = measure(mesh, truth, &grid, choose(find_method("classic")));
///
/// Times are CPU seconds that the process spends in a single pass, summed over all threads. So nothing else may run in
/// the process meanwhile, and these functions must not run concurrently.
#pragma once

#include "alcove/bake/detail/error_figures.h"
#include "alcove/field/level_stack.h"
#include "alcove/mesh/mesh.h"
#include "alcove/occlusion/catalog.h"

namespace alcove {

/// A mesh with the data that all methods share.
struct MeasuredMesh {
    /// \throw InputError if no vertex has a normal, and what RaySurface throws.
    MeasuredMesh(std::string name, Mesh mesh);

    std::string name;
    Mesh mesh;
    std::vector<Triangle> triangles;
    Frame frame;
    std::vector<Surfel> surfels;
    std::vector<std::uint32_t> order; ///< spatial_order() of the surfels
    double tree_seconds = 0.0;        ///< time to build `rays`
    RaySurface rays;

  private:
    RaySurface make_rays();
};

struct TruthOptions {
    int rays = 1024;           ///< per vertex, >= 1; the error of the truth itself is about 0.003
    std::size_t most = 20'000; ///< maximum number of vertices, >= 1
    std::size_t labels = 0;    ///< vertices of Truth::labels, at most a quarter of all
};
/// The number of labels in a planned bake with an error of 0.02.
inline constexpr std::size_t labels_of_pilot = 512;

/// Reference ao at some vertices, from exact rays whose seed differs from that of a bake.
struct Truth {
    float radius = 0.0f; ///< unit space; may be infinite
    /// All vertices with a normal except those of `labels`, or a subset that is evenly spaced along the Morton curve.
    std::vector<std::uint32_t> vertices;
    std::vector<float> ao; ///< one value per entry of `vertices`
    /// Reference ao at other vertices, to which methods fit their network. Null if none is requested, or if the mesh is
    /// small.
    std::shared_ptr<const Labels> labels;
};
Truth make_truth(const MeasuredMesh& mesh, float radius, const TruthOptions& options = {},
                 const Progress& progress = {});

/// A field, built once for all methods that probe it.
struct MeasuredGrid {
    LevelStack field;
    float asked_voxel;                ///< requested voxel, unit space; 0 if chosen automatically
    std::size_t active_voxels, bytes; ///< of all levels
    double seconds;                   ///< time to voxelize and to build the field
    std::size_t peak_rss_bytes;       ///< peak memory of the process during that time
};

/// Builds the grid as a bake does, with clustered vertices on dense surfaces. `radius` and `voxel` are in unit space;
/// if `voxel` is 0, the voxel size is chosen automatically. \throw what voxelize() throws.
MeasuredGrid build_grid(const MeasuredMesh& mesh, float radius, float voxel, const Progress& progress = {});

struct Measurement {
    std::string mesh, method;
    int samples = 0; ///< as in MethodChoice
    std::size_t vertices = 0, triangles = 0;
    float radius = 0.0f;      ///< unit space; may be infinite
    float voxel = 0.0f;       ///< finest voxel, unit space; 0 if the method uses no grid
    float asked_voxel = 0.0f; ///< requested voxel, unit space; 0 if chosen automatically
    std::size_t levels = 0, active_voxels = 0;
    ErrorFigures error;
    double grid_seconds = 0.0;      ///< 0 if the method uses no grid
    double tree_seconds = 0.0;      ///< time to build the BVH; 0 if the method does not trace the mesh
    double occlusion_seconds = 0.0; ///< for all vertices
    double map_calls = 0.0;         ///< per vertex; counted at up to 1,024 vertices
    double rays = 0.0;              ///< per vertex, through the grid or against the mesh
    std::size_t grid_bytes = 0;
    std::size_t peak_rss_bytes = 0; ///< peak memory of the process during grid build and bake; 0 if unknown
    std::string picture;            ///< image of the error on the mesh, as a data URI; may be empty

    double seconds() const { return grid_seconds + tree_seconds + occlusion_seconds; }
    std::string label() const; ///< "guided:3", "multiscale"
};

enum class Pictures : bool { none, painted };

/// Bakes all vertices at the radius of the reference and compares those that have a reference value. `grid` may be null
/// for methods that use none. \throw what the method throws.
Measurement measure(const MeasuredMesh& mesh, const Truth& truth, const MeasuredGrid* grid, const MethodChoice& choice,
                    Pictures pictures = Pictures::none, const Progress& progress = {});

}
