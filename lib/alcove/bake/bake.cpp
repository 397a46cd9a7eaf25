#include "alcove/bake/bake.h"

#include "alcove/bake/detail/input_warnings.h"
#include "alcove/bake/detail/options.h"
#include "alcove/bake/detail/parts.h"
#include "alcove/bake/detail/provenance.h"
#include "alcove/bake/detail/selection.h"
#include "alcove/bake/detail/surface_points.h"
#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/detail/stopwatch.h"
#include "alcove/base/parallel.h"
#include "alcove/base/types.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/detail/join.h"
#include "alcove/mesh/detail/source.h"
#include "alcove/mesh/detail/srgb.h"
#include "alcove/mesh/triangulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

/// A mesh and the data that all bake targets on it share.
struct PreparedMesh {
    Mesh of_selection;               ///< has only faces that are baked or occlude; set if there is a selection
    const Mesh* whole;               ///< the mesh with all its faces
    std::vector<Triangle> triangles; ///< of the faces that occlude
    Frame frame;
    VoxelizeOptions voxelizing;
    float radius;
    std::optional<GridStack> grid{}; ///< BakeOptions::grid, moved to the mesh's frame and extended to the radius
    std::optional<SelectedFaces> selected{};

    const Mesh& mesh() const { return selected ? of_selection : *whole; }
};

std::string named(const Mesh& mesh, const std::string& message) {
    return mesh.name.empty() || message.starts_with(mesh.name) ? message : mesh.name + ": " + message;
}

/// Computed by Newell's method (Tampieri 1992), which also works for non-planar polygons.
Vec3 face_normal(const Mesh& mesh, std::uint32_t face) {
    const std::span<const std::uint32_t> corners = mesh.face(face);
    Vec3d sum(0.0);
    for (std::size_t c = 0; c < corners.size(); ++c)
        sum += glm::cross(mesh.positions[corners[c]] - mesh.positions[corners[0]],
                          mesh.positions[corners[(c + 1) % corners.size()]] - mesh.positions[corners[0]]);
    return unit_or_zero(sum);
}

/// Detects a grid that belongs to another mesh, or to this mesh at another position. In both cases, many vertices are
/// far from the surface of the grid.
void check_distance(GridStack grid, const PreparedMesh& prepared, std::vector<std::string>& warnings) {
    grid.levels.resize(1);
    const LevelStack field(grid);
    const Mesh& mesh = prepared.mesh();
    const std::vector<std::uint8_t> used = mesh.used_vertices();
    std::size_t count = 0, off = 0;
    for (std::size_t v = 0; v < used.size(); ++v)
        if (used[v] && is_finite(mesh.positions[v])) {
            ++count;
            off += std::fabs(field.map(prepared.frame.to_unit(mesh.positions[v]))) > 2.0f * field.resolution();
        }
    const std::string what = fmt::format("{} of {} vertices are more than two voxels off the surface of the grid",
                                         grouped(off), grouped(count));
    if (off > count / 2)
        throw InputError(what + ": give the grid of this mesh, or none");
    if (off > count / 100)
        warnings.push_back(what + ": is it the grid of this mesh?");
}

void take_grid(PreparedMesh& prepared, const BakeOptions& options, std::vector<std::string>& warnings) {
    GridStack stack = reframed(*options.grid, prepared.frame);
    const bool inside = prepared.voxelizing.grid.inner_band == prepared.voxelizing.grid.outer_band;
    const float reach = stack.reach();
    check_distance(stack, prepared, warnings);
    if (inside && !stack.knows_inside())
        warnings.emplace_back(
            "the grid does not reach far enough inside for these attributes, so it is voxelized "
            "again from its own surface; to avoid this, save the grid of a bake with these attributes");
    else if (reach < std::min(prepared.radius, 1.0f))
        warnings.push_back(
            fmt::format("the grid stores distances only up to {:.4g}, less than the radius: coarser levels are "
                        "computed from its surface; a band as wide as the radius avoids this",
                        reach * prepared.frame.diagonal));
    prepared.grid = extend_levels(std::move(stack), prepared.radius, inside);
}

/// Whether any triangle has a nonzero area in unit space, the space of grids and rays.
bool has_area(const PreparedMesh& prepared) {
    const auto unit = [&](std::uint32_t v) {
        return (prepared.mesh().positions[v] - prepared.frame.center) / prepared.frame.diagonal;
    };
    return std::any_of(prepared.triangles.begin(), prepared.triangles.end(), [&](const Triangle& t) {
        const Vec3d origin = unit(t[0]), a = unit(t[1]) - origin, b = unit(t[2]) - origin;
        return glm::length(glm::cross(a, b)) > flat_sine * glm::length(a) * glm::length(b);
    });
}

/// The triangles of the faces of `mesh` that occlude.
std::vector<Triangle> occluding_triangles(const Mesh& mesh, const PreparedMesh& prepared) {
    std::vector<Triangle> triangles = triangulate(mesh).triangles;
    if (!prepared.selected)
        return triangles;
    const std::vector<std::uint32_t> faces = faces_of_triangles(mesh);
    std::size_t kept = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t)
        if (prepared.selected->occluding[faces[t]])
            triangles[kept++] = triangles[t];
    triangles.resize(kept);
    return triangles;
}

PreparedMesh prepare(const Mesh& mesh, const BakeOptions& options, std::vector<std::string>& warnings) {
    PreparedMesh prepared{{}, &mesh, {}, {}, {}, 0.0f};
    if (!options.faces.empty()) {
        prepared.selected = select_faces(mesh, options.faces);
        prepared.of_selection = remaining(mesh, *prepared.selected);
    }
    prepared.triangles = occluding_triangles(mesh, prepared);
    prepared.frame = frame_of(prepared.mesh().box());
    if (prepared.triangles.empty() && !options.faces.no_occlude.empty())
        throw InputError("--no-occlude and --opaque-only leave no face that occludes: name fewer parts");
    if (!has_area(prepared)) // voxelize() detects this too, but not every bake voxelizes
        throw InputError("the mesh has no face with nonzero area: there is no surface to occlude anything");
    prepared.voxelizing = voxelizing_of(options, prepared.frame);
    prepared.radius = radius_of(options, prepared.frame, prepared.voxelizing);
    if (options.grid)
        take_grid(prepared, options, warnings);
    return prepared;
}

/// 1 for each vertex of a face that is baked; empty without a selection.
std::vector<std::uint8_t> selected_vertices(const Mesh& whole, const PreparedMesh& prepared) {
    if (!prepared.selected)
        return {};
    std::vector<std::uint8_t> vertices(whole.vertex_count(), 0);
    for (std::size_t f = 0; f < whole.face_count(); ++f)
        if (prepared.selected->baked[f])
            for (const std::uint32_t v : whole.face(f))
                vertices[v] = 1;
    return vertices;
}

std::vector<Surfel> surfels_of_vertices(const PreparedMesh& prepared, NormalSource normals) {
    const Mesh& mesh = prepared.mesh();
    if (!prepared.selected)
        return make_surfels(mesh, prepared.triangles, prepared.frame, normals);
    // The normals also depend on faces that do not occlude.
    std::vector<Surfel> surfels = make_surfels(mesh, triangulate(mesh).triangles, prepared.frame, normals);
    const std::vector<std::uint8_t> selected = selected_vertices(*prepared.whole, prepared);
    for (std::size_t v = 0; v < surfels.size(); ++v)
        if (!selected[v])
            surfels[v].normal = Vec3(0.0f);
    return surfels;
}

std::vector<Surfel> surfels_of_points(const PreparedMesh& prepared, const SurfacePoints& points) {
    const Mesh& mesh = *prepared.whole; // because points refer to its faces
    std::vector<Surfel> surfels = huge_vector<Surfel>(points.count, {Vec3(0.0f), Vec3(0.0f)});
    parallel_for(points.count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const SurfacePoint point = points.point(i);
            if (point.face != no_face && point.face >= mesh.face_count())
                throw InputError(
                    fmt::format("a point refers to face {}, but the mesh has {} faces", point.face, mesh.face_count()));
            if (!is_finite(point.position))
                continue;
            surfels[i].position = prepared.frame.to_unit(point.position);
            surfels[i].normal = unit_or_zero(Vec3d(point.normal));
            if (surfels[i].normal == Vec3(0.0f) && point.face != no_face)
                surfels[i].normal = face_normal(mesh, point.face);
        }
    });
    return surfels;
}

Baked to_baked(TargetResult result, const BakeTask& task, const PreparedMesh& prepared) {
    Baked baked;
    baked.values = std::move(result.values);
    for (float& thickness : baked.values[Channel::thickness])
        thickness = static_cast<float>(thickness * prepared.frame.diagonal);
    baked.attributes = task.attributes;
    baked.method = result.choice.label();
    if (result.choice.samples > 0)
        baked.samples = result.choice.samples;
    baked.evaluated = result.evaluated;
    baked.reason = std::move(result.reason);
    baked.rmse = result.rmse;
    baked.target = task.target_error;
    baked.radius = double(prepared.radius) * prepared.frame.diagonal;
    baked.grid_summary = result.grid;
    baked.grid = std::move(result.stack);
    baked.seconds = result.seconds;
    baked.warnings = std::move(result.warnings);
    return baked;
}

/// Describes the surfels that bake_surfels() bakes on a mesh.
struct SurfelSource {
    std::string_view name; ///< name of the surfels in warnings
    bool of_vertices;
    bool by_parts;
    bool is_reconstructed; ///< whether the mesh was made from points
    std::function<std::vector<Surfel>(const PreparedMesh&)> surfels;
    IsOwnFace is_own_face;
    std::function<std::vector<Surfel>(const PreparedMesh&, std::span<const float> ao)> more{}; ///< see BakeTarget
    double error_share = 1.0;                                                                  ///< see SurfacePoints
};

Baked bake_surfels(const Mesh& mesh, const BakeOptions& options, const SurfelSource& source) {
    const ThreadLimit limit(options.threads);
    check(options);
    BakeTask task = task_of(options);
    if (task.error)
        *task.error *= source.error_share;
    Stopwatch watch;
    std::vector<std::string> warnings;
    try {
        const PreparedMesh prepared = prepare(mesh, options, warnings);
        Surroundings surroundings(options, prepared.mesh(), prepared.frame, prepared.radius, warnings);
        VoxelizeOptions voxelizing = prepared.voxelizing;
        voxelizing.warns_of_faces = !source.is_reconstructed;
        BakeTarget whole{prepared.mesh(),
                         prepared.triangles,
                         prepared.frame,
                         source.surfels(prepared),
                         prepared.radius,
                         voxelizing,
                         prepared.grid ? &*prepared.grid : nullptr};
        whole.is_own_face = source.is_own_face;
        if (source.more)
            whole.more = [&](std::span<const float> ao) { return source.more(prepared, ao); };
        for (std::string& warning : input_warnings(whole, source.name, source.of_vertices, options))
            warnings.push_back(std::move(warning));
        const double preparing = watch.lap();
        TargetResult result = source.by_parts ? bake_parts(whole, task, options.normals, surroundings, options.progress)
                                              : bake_target(whole, task, surroundings, options.progress);
        result.seconds.grid += preparing;
        Baked baked = to_baked(std::move(result), task, prepared);
        if (source.of_vertices)
            baked.selected = selected_vertices(mesh, prepared);
        baked.warnings.insert(baked.warnings.begin(), warnings.begin(), warnings.end());
        return baked;
    } catch (const InputError& error) {
        throw InputError(named(mesh, error.what()));
    } catch (const LimitError& error) {
        throw LimitError(named(mesh, error.what()));
    } catch (const MemoryError& error) {
        throw MemoryError(named(mesh, error.what()));
    } catch (const TimeLimitError& error) {
        throw TimeLimitError(named(mesh, error.what()));
    }
}

Baked bake_vertices(const Mesh& mesh, const BakeOptions& options) {
    const auto surfels = [&](const PreparedMesh& prepared) { return surfels_of_vertices(prepared, options.normals); };
    return bake_surfels(mesh, options,
                        {.name = "vertices",
                         .of_vertices = true,
                         .by_parts = options.self,
                         .is_reconstructed = false,
                         .surfels = surfels,
                         .is_own_face = uses_vertex});
}

/// Bakes the mesh after joining its vertices, and gives each original vertex the values of the vertex that it became.
Baked bake_joined(Mesh mesh, const BakeOptions& options) {
    check(options);
    if (options.normals == NormalSource::angle || options.normals == NormalSource::area)
        mesh.normals.clear(); // not used, and they would keep joined vertices separate
    mesh.warnings.clear();
    const JoinedMesh joined = join_vertices(mesh, *options.weld);
    Baked baked = bake_vertices(joined.mesh, options);
    for (const ChannelInfo& channel : channels) {
        std::vector<float> values;
        if (baked.attributes.has(channel.channel))
            for (const std::uint32_t v : joined.vertex_of) {
                const auto first = baked[channel.channel].begin() + static_cast<std::ptrdiff_t>(v * channel.components);
                values.insert(values.end(), first, first + static_cast<std::ptrdiff_t>(channel.components));
            }
        baked.values[channel.channel] = std::move(values);
    }
    if (!baked.selected.empty()) {
        std::vector<std::uint8_t> selected;
        selected.reserve(joined.vertex_of.size());
        for (const std::uint32_t v : joined.vertex_of)
            selected.push_back(baked.selected[v]);
        baked.selected = std::move(selected);
    }
    baked.warnings.insert(baked.warnings.begin(), joined.mesh.warnings.begin(), joined.mesh.warnings.end());
    return baked;
}

SurfacePoints in_memory(std::span<const SurfacePoint> points) {
    return {points.size(), [points](std::size_t i) { return points[i]; },
            [points](std::size_t i) { return points[i].face; }};
}

Baked bake_on_surface(const Mesh& mesh, const SurfacePoints& points, const BakeOptions& options,
                      bool is_reconstructed) {
    const auto surfels = [&](const PreparedMesh& prepared) { return surfels_of_points(prepared, points); };
    std::vector<SurfacePoint> further;
    const auto more = [&](const PreparedMesh& prepared, std::span<const float> ao) {
        further = points.more(ao);
        return surfels_of_points(prepared, in_memory(further));
    };
    const auto is_own_face = [&](std::size_t i, const Triangle& t) {
        const std::uint32_t face_of_point = i < points.count ? points.face(i) : further[i - points.count].face;
        if (face_of_point == no_face)
            return false;
        const std::span<const std::uint32_t> face = mesh.face(face_of_point);
        return std::all_of(t.begin(), t.end(), [&](std::uint32_t corner) {
            return std::find(face.begin(), face.end(), corner) != face.end();
        });
    };
    return bake_surfels(mesh, options,
                        {.name = "points",
                         .of_vertices = false,
                         .by_parts = false,
                         .is_reconstructed = is_reconstructed,
                         .surfels = surfels,
                         .is_own_face = is_own_face,
                         .more = points.more ? more : decltype(SurfelSource::more)(),
                         .error_share = points.error_share});
}

/// Bakes the points of a mesh without faces on the surface that is reconstructed from them.
Baked bake_point_cloud(const Mesh& mesh, const BakeOptions& options) {
    const ThreadLimit limit(options.threads);
    check(options);
    if (options.self || options.weld)
        throw InputError(named(mesh, "--self and --weld are for meshes, but these are points: leave them out"));
    if (options.grid)
        throw InputError(named(mesh, "--grid is for meshes: the surface of points is reconstructed in each bake"));
    // Detail that is small compared with the radius hardly changes the occlusion.
    constexpr float voxels_per_radius = 48.0f, large_radius = 0.25f;
    const float radius = radius_of(options, frame_of(mesh.box()), {});
    const PointSurface surface =
        surface_of_points(mesh, {options.point_size, std::min(radius, large_radius) / voxels_per_radius});
    const SurfacePoints points{mesh.vertex_count(),
                               [&](std::size_t i) {
                                   return SurfacePoint{surface.positions[i], surface.normals[i], surface.faces[i]};
                               },
                               [&](std::size_t i) { return surface.faces[i]; }};
    BakeOptions on_surface = options;
    if (options.sign == SignChoice::automatic)
        on_surface.sign = SignChoice::sheet; // scans have holes
    Baked baked = bake_on_surface(surface.mesh, points, on_surface, true);
    baked.warnings.insert(baked.warnings.begin(), surface.mesh.warnings.begin(), surface.mesh.warnings.end());
    return baked;
}

bool has_property(const Mesh& mesh, std::string_view name) {
    return mesh.source && mesh.source->has_vertex_property(name);
}

bool has_colors(const Mesh& mesh) {
    return !mesh.vertex_colors.empty() || has_property(mesh, "red") || has_property(mesh, "green") ||
           has_property(mesh, "blue") || has_property(mesh, "alpha");
}

/// Whether to add ao as colours and `quality`: by default, only if the mesh has neither. In an .obj, ao also replaces
/// colours if a comment in the file shows that an earlier bake wrote them.
bool wants_colors(ColorUse use, const Baked& baked, const Mesh& mesh) {
    if (!baked.attributes.has(Channel::ao) || use != ColorUse::automatic)
        return baked.attributes.has(Channel::ao) && use != ColorUse::none;
    if (mesh.format == "OBJ" && !earlier_bake(mesh).empty())
        return true;
    return !has_colors(mesh) && (!has_property(mesh, "quality") || names_value(earlier_bake(mesh), "quality"));
}

/// The colours of the mesh, white if it has none, multiplied by ao in linear light.
std::vector<Color> multiplied(const Mesh& mesh, const std::vector<float>& ao) {
    std::vector<Color> colors = mesh.vertex_colors;
    colors.resize(ao.size(), {255, 255, 255, 255});
    for (std::size_t v = 0; v < colors.size(); ++v) {
        Vec3 linear;
        for (int c = 0; c < 3; ++c)
            linear[c] = static_cast<float>(decode_srgb(colors[v][static_cast<std::size_t>(c)] / 255.0)) * ao[v];
        const std::uint8_t alpha = colors[v][3];
        colors[v] = srgb_color(linear);
        colors[v][3] = alpha;
    }
    return colors;
}

/// Warns if viewers will show colours that are not this ao.
void warn_of_kept_colors(Mesh& mesh, const std::vector<float>& ao, ColorUse use) {
    const std::vector<Color>& colors = mesh.vertex_colors;
    if (ao.empty() || colors == grey_colors(ao) || colors == grey_colors(ao, ColorEncoding::raw))
        return;
    if (has_baked_colors(mesh))
        mesh.warnings.emplace_back(
            "the vertex colours are kept, but they do not show this ao: an earlier bake may have made them; "
            "add --color ao to replace them");
    else if (use == ColorUse::automatic)
        mesh.warnings.push_back(fmt::format("the {} of the input is kept, so viewers may not show ao, which is in the "
                                            "property 'ao' only: add --color ao to show it instead",
                                            has_colors(mesh) ? "vertex colour" : "'quality'"));
}

}

double rmse_of(Quality quality) {
    switch (quality) {
    case Quality::draft:
        return 0.05;
    case Quality::good:
        return 0.02;
    default:
        return 0.005;
    }
}

std::string GridSummary::text() const {
    if (levels == 0)
        return "on the mesh itself";
    return fmt::format("{}, {} grid level{}, finest voxel {:.4g}{}", sign == Sign::solid ? "solid" : "sheet", levels,
                       levels == 1 ? "" : "s", voxel, clustered ? ", vertices within half a voxel clustered" : "");
}

Baked bake(const Mesh& mesh, const BakeOptions& options) {
    if (mesh.face_count() == 0)
        return bake_point_cloud(mesh, options);
    return options.weld ? bake_joined(mesh, options) : bake_vertices(mesh, options);
}

Baked bake(const Mesh& mesh, std::span<const SurfacePoint> points, const BakeOptions& options) {
    return bake_points(mesh, in_memory(points), options);
}

Baked bake_points(const Mesh& mesh, const SurfacePoints& points, const BakeOptions& options) {
    return bake_on_surface(mesh, points, options, false);
}

bool add(Mesh& mesh, const Baked& baked, const AddOptions& options) {
    for (const ChannelInfo& channel : channels)
        if (const auto& values = baked[channel.channel];
            !values.empty() && values.size() != mesh.vertex_count() * channel.components)
            throw InputError(fmt::format("{} values of {} were baked, but the mesh has {} vertices",
                                         values.size() / channel.components, channel.name, mesh.vertex_count()));
    const bool colored = wants_colors(options.color, baked, mesh);
    // Replace the `quality` of an earlier bake, which would be out of date.
    const bool rated =
        colored || (!baked.ao().empty() && has_property(mesh, "quality") && names_value(earlier_bake(mesh), "quality"));
    if (colored && options.color == ColorUse::multiply && !mesh.vertex_colors.empty() && !earlier_bake(mesh).empty())
        mesh.warnings.emplace_back(
            "an earlier bake may have made the vertex colours or multiplied them already: multiply "
            "those of the original file");
    if (colored) {
        mesh.added_colors = options.color == ColorUse::multiply ? multiplied(mesh, baked.ao())
                                                                : grey_colors(baked.ao(), options.encoding);
        mesh.added_encoding = options.color == ColorUse::multiply ? ColorEncoding::srgb : options.encoding;
    } else
        warn_of_kept_colors(mesh, baked.ao(), options.color);
    if (rated)
        mesh.set_attribute({"quality", 1, baked.ao()});
    for (const ChannelInfo& channel : channels)
        if (const auto& values = baked[channel.channel]; !values.empty())
            mesh.set_attribute({std::string(channel.name), static_cast<int>(channel.components), values});
    const GridSummary& grid = baked.grid_summary;
    mesh.baked_vertices = baked.selected;
    constexpr double usual_error = 0.02;
    mesh.instance_error = baked.target.value_or(baked.rmse.value_or(usual_error));
    mesh.added_comments.push_back(fmt::format("{}{}: {}{} by {}, radius {:.6g}, {}", provenance, ALCOVE_VERSION,
                                              names_of(baked.attributes), rated ? ", quality" : "", baked.method,
                                              baked.radius,
                                              grid.levels > 0 ? fmt::format("voxel {:.6g}", grid.voxel) : grid.text()));
    return colored;
}

}
