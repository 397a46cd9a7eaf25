/// Bakes the ambient occlusion of a mesh in one call.
///
///     auto mesh = alcove::read_mesh("dragon.ply");
///     const auto baked = alcove::bake(mesh, {.radius = "10%", .quality = alcove::Quality::good});
///     alcove::add(mesh, baked);
///     alcove::write_mesh(mesh, "dragon_ao.ply");
#pragma once

#include "alcove/base/types.h"
#include "alcove/grid/grid_stack.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/files.h"
#include "alcove/mesh/mesh.h"
#include "alcove/mesh/normals.h"
#include "alcove/occlusion/channels.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace alcove {

/// The largest RMSE of the baked ao against exact rays, the reference: 0.05, 0.02 or 0.005.
enum class Quality { draft, good, fine };
double rmse_of(Quality quality);

/// The methods that the planner may choose.
enum class Via {
    /// Calibrated or guided, on the field. Exact if the field costs far more, cannot meet the error, is too coarse for
    /// the radius, or does not fit in memory.
    grid,
    automatic, ///< the cheapest of calibrated, guided and exact
    mesh,      ///< exact rays on the triangles
};

/// Receives the current work ("voxelizing", "baking") and the share of this work that is done, in [0, 1]. The share
/// restarts if the planner bakes again. Never called by two threads at once. An exception thrown by this function ends
/// the bake; Cancellable ends it sooner.
using BakeProgress = std::function<void(std::string_view work, double done)>;

/// Selects faces by the names of their FaceGroups. In a name, * stands for any text and ? for any one character.
struct FaceSelection {
    std::vector<std::string> only{};       ///< bake only these; all other faces still occlude
    std::vector<std::string> exclude{};    ///< neither bake these nor let them occlude
    std::vector<std::string> no_occlude{}; ///< do not let these occlude
    bool opaque_only = false;              ///< do not let masked or blended faces occlude

    bool empty() const { return only.empty() && exclude.empty() && no_occlude.empty() && !opaque_only; }
};

struct BakeOptions {
    /// Maximum distance of occluders, > 0; may be infinite. A length in voxels needs `voxel` or `grid`.
    Length radius = "10%";
    /// The RMSE to meet. The planner chooses the method, rays, voxel and probes. No effect if `method` is named.
    Quality quality = Quality::good;
    Via via = Via::grid; ///< no effect if `method` is named
    /// The RMSE to meet, in [0.001, 1), instead of that of `quality`.
    std::optional<double> error{};
    /// A method of the catalog; if empty, the planner chooses one. Without `error`, the method runs with its defaults
    /// and `parameters`; with `error`, the number of its rays or samples is chosen to meet the error. On meshes with
    /// few vertices, guided, traced and the methods that the planner chooses cast more rays, up to 4,096 per vertex. If
    /// the voxel is larger than half the radius, guided casts at least 32 rays, because the field does not help then.
    std::string method{};
    /// Parameters of `method` by their names in the catalog.
    std::vector<std::pair<std::string, double>> parameters{};
    std::uint32_t seed = 0; ///< of the ray directions

    FaceSelection faces{};         ///< by default all; vertices without a baked face get ChannelInfo::missing
    std::vector<Mesh> occluders{}; ///< meshes that also occlude, in the same coordinates
    bool ground = false;           ///< the plane through the lowest vertex also occludes
    Vec3d up{0.0, 1.0, 0.0};       ///< normal of the ground; any length except 0
    bool self = false;             ///< each connected part is occluded only by itself, `occluders` and `ground`

    ChannelSet attributes = Channel::ao;
    NormalSource normals = NormalSource::automatic;
    SignChoice sign = SignChoice::automatic;
    /// Joins vertices within this distance of each other before the bake; finite and not in voxels. This closes gaps
    /// that rounding in an exporter has caused. Each vertex gets the values of the vertex that represents it.
    std::optional<Length> weld{};
    /// The distance between the points of a mesh without faces: see PointOptions::point_size.
    std::optional<Length> point_size{};
    std::optional<Length> voxel{};   ///< edge of the finest voxel, finite, not in voxels; empty: automatic
    const GridStack* grid = nullptr; ///< level sets of the mesh, used instead of voxelizing the mesh
    /// Return the level sets in Baked::grid. They are then built even if no method needs them, and from all triangles.
    bool keep_grid = false;

    /// Measure the error of the bake with reference rays, and fit `calibrated` to some of them. A planned bake needs
    /// this.
    bool pilot = true;
    /// Limit of the wall-clock seconds since the call, > 0. A bake is refused if its estimated time clearly exceeds the
    /// limit; a running bake is not stopped.
    std::optional<double> time_limit{};
    BakeProgress progress{};
    unsigned threads = 0; ///< 0: one per core
};

/// Wall-clock seconds of the stages of a bake.
struct BakeSeconds {
    double grid = 0.0;      ///< triangulation, level sets, their field and the BVH for rays
    double pilot = 0.0;     ///< reference rays of the pilot
    double occlusion = 0.0; ///< the method itself, in all attempts of the planner
};

/// The level sets that a bake used; `levels` is 0 if the bake used none. If several parts were baked, the summary has
/// the largest voxel and the largest numbers of levels and bytes.
struct GridSummary {
    double voxel = 0.0; ///< finest, scene units
    std::size_t levels = 0;
    std::size_t bytes = 0; ///< including the grids of occluders
    Sign sign = Sign::solid;
    bool clustered = false; ///< built from clustered vertices, see GridOptions::cluster

    std::string text() const; ///< such as "solid, 3 grid levels, finest voxel 0.01"
};

struct Baked {
    /// One entry per vertex or point, in input order; lengths in scene units. Attributes that were not requested are
    /// empty. Entries without a normal are ChannelInfo::missing.
    ChannelValues values;
    ChannelSet attributes;
    /// 1 for each vertex of a face that BakeOptions::faces selects, else 0. Empty without a selection.
    std::vector<std::uint8_t> selected;

    std::string method;         ///< including its number of rays or samples: "guided:3"
    std::optional<int> samples; ///< rays or samples per vertex or point; empty if the method has neither
    /// The share of the vertices or points at which the method was evaluated; the values of the others were
    /// interpolated. Less than 1 only if there is an RMSE to meet and the points are much denser than the details of
    /// the ao.
    double evaluated = 1.0;
    std::string reason;           ///< why the planner chose exact despite Via::grid; otherwise empty
    std::optional<double> rmse;   ///< of ao, estimated by the pilot; empty without a pilot
    std::optional<double> target; ///< the RMSE to meet; empty for a method with its defaults
    double radius = 0.0;          ///< scene units; may be infinite
    GridSummary grid_summary;
    GridStack grid; ///< see BakeOptions::keep_grid
    BakeSeconds seconds;
    std::vector<std::string> warnings; ///< one line each: a defect of the result and its fix

    const std::vector<float>& ao() const& { return values[Channel::ao]; }
    std::vector<float> ao() && { return std::move(values[Channel::ao]); }
    const std::vector<float>& operator[](Channel channel) const { return values[channel]; }
    /// Whether the estimated RMSE exceeds the target.
    bool missed() const { return rmse && target && *rmse > *target; }
};

/// Checks options without a mesh. \throw InputError if options contradict each other or are out of range; the message
/// is one line that names these options.
void check(const BakeOptions& options);

/// Bakes the vertices of a mesh. Vertices of a mesh without faces are baked as points on the surface that
/// surface_of_points() reconstructs. The values do not depend on the number of threads. Warnings and messages use the
/// option names of the command line: --radius is BakeOptions::radius.
///
/// Thread-safety: concurrent calls must have the same `threads`, because this limit applies to the whole process. They
/// should have no `time_limit`, because it is checked with the CPU time of the whole process.
/// Cost: at quality good, from 1 µs per vertex on dense scans to about 5 µs on small meshes, plus 50 to 100 ms for the
/// pilot.
/// \throw InputError like check(). Also if no face has a nonzero area, if the mesh lacks the normals that
/// NormalSource::file requires, or if most vertices are more than two voxels off the surface of BakeOptions::grid.
/// LimitError if the grids exceed the memory limit (by default half of the memory), MemoryError if the system runs out
/// of memory. TimeLimitError, see BakeOptions::time_limit. Any exception of BakeOptions::progress.
Baked bake(const Mesh& mesh, const BakeOptions& options = {});

inline constexpr std::uint32_t no_face = ~std::uint32_t{0};

/// A point to bake other than a vertex: a texel, a corner, a sample.
struct SurfacePoint {
    Vec3d position{0.0}; ///< scene units
    Vec3 normal{0.0f};   ///< any length; zero: the normal of the face
    /// Index of the face on which the point lies. Without this index, a face that the point touches counts as its own
    /// if the normal of the face is within 60° of `normal`.
    std::uint32_t face = no_face;
};

/// Bakes points on or near a mesh, as bake() above bakes vertices. `normals`, `weld` and `self` have no effect. A point
/// without a normal or with a non-finite position gets ChannelInfo::missing (ao = 1). \throw like bake() above, and
/// InputError for a face index that is out of range.
Baked bake(const Mesh& mesh, std::span<const SurfacePoint> points, const BakeOptions& options = {});

/// Splits faces where interpolating ao between vertices would be off by more than `error` (or the RMSE of `quality`),
/// so that vertex values can represent ao. For example, a floor that is a single quad gets the shadow of a box on it.
/// An edge is not split if it is at most 1/16 of the radius, or 1/64 of the diagonal if the radius exceeds a quarter of
/// the diagonal. The result has at most a million faces or four times as many as the mesh, whichever is more. The data
/// of the mesh are interpolated as in tessellate(). `method`, `via`, `self`, `weld`, `progress` and `time_limit` have
/// no effect.
///
/// Cost: 256 exact rays per vertex and per tested point. Thread-safety as bake(). \throw InputError and LimitError
/// as bake() and tessellate().
Mesh tessellate_for_ao(const Mesh& mesh, const BakeOptions& options = {});

/// What add() does with ao in addition to the attribute `ao`.
enum class ColorUse {
    automatic, ///< adds vertex colours and `quality`, unless the mesh already has colours or its own `quality`
    ao,        ///< adds both, and replaces those of the mesh
    multiply,  ///< adds both; the colours are those of the mesh, multiplied by ao
    none,      ///< adds neither
};
struct AddOptions {
    ColorUse color = ColorUse::automatic;
    ColorEncoding encoding = ColorEncoding::srgb;
};

/// Adds the baked values to `mesh` as vertex attributes named after their channels, and a comment with the method and
/// its settings. The channel `ao` is also added as colours and as `quality` (see ColorUse). Adds a warning to `mesh` if
/// the mesh keeps colours that do not show this ao. \return whether colours were added.
/// \throw InputError if the numbers of values and vertices do not match. Cost: linear.
bool add(Mesh& mesh, const Baked& baked, const AddOptions& options = {});

}
