#include "alcove/bake/detail/causes.h"

#include "alcove/field/detail/trace.h"
#include "alcove/grid/detail/plan.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/occlusion/detail/subset.h"
#include "alcove/occlusion/detail/thin_walls.h"
#include "alcove/occlusion/methods/exact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alcove {
namespace {

constexpr double large_rmse = 0.1, thin_wall_rmse = 0.03;
constexpr std::size_t max_surfels = 4096;

/// The finest voxel that may be requested, unit space; infinite if the grid is given.
double finest_possible_voxel(const BakeTarget& target) {
    if (target.grid)
        return std::numeric_limits<double>::infinity();
    return finest_voxel(surface_size(target.mesh, target.triangles), target.triangles.size(), target.voxelizing.grid);
}

std::string thin_walls_warning(const BakeTarget& target, const Occluders& occluders) {
    const AnyField& field = occluders.field();
    const ThinWalls walls = thin_walls(target.surfels, occluders.rays(), resolution(field), two_sided(field));
    if (!walls.noticeable())
        return {};
    constexpr double clearly = 0.98; // the voxel is printed with three digits and must not be rounded up
    const double fine_enough = clearly * double(walls.voxel), diagonal = target.frame.diagonal;
    const std::string finer =
        fine_enough < finest_possible_voxel(target) ? "" : fmt::format("--voxel {:.3g}, or ", fine_enough * diagonal);
    return fmt::format("{:.1f} % of the vertices are on walls too thin for the voxel of {:.3g}, so rays through "
                       "the grid may miss them: use {}--method guided, which traces rays against the triangles",
                       100.0 * walls.share, double(resolution(field)) * diagonal, finer);
}

std::string flipped_normals_warning(const BakeTarget& target) {
    const std::vector<Vec3> of_faces = area_weighted_normals(target.mesh, target.triangles);
    if (of_faces.size() != target.surfels.size())
        return {};
    std::size_t against = 0, compared = 0;
    for (std::size_t v = 0; v < of_faces.size(); ++v) {
        if (of_faces[v] == Vec3(0.0f) || !target.surfels[v].has_normal())
            continue;
        ++compared;
        against += glm::dot(of_faces[v], target.surfels[v].normal) < 0.0f;
    }
    if (2 * against <= compared)
        return {};
    return fmt::format("the normals of the file point to the back of the faces at {:.0f} % of the vertices: use "
                       "--normals area, or flip them",
                       100.0 * static_cast<double>(against) / static_cast<double>(compared));
}

/// Whether the surfel lies on a face that has no vertex at its position.
bool lies_on_another_face(const Surfel& surfel, const Mesh& mesh, const Frame& frame, const RaySurface& surface,
                          float offset) {
    const Vec3 side = std::fabs(surfel.normal.x) < 0.5f ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 tangent = glm::normalize(glm::cross(surfel.normal, side));
    const Vec3 bitangent = glm::cross(surfel.normal, tangent);
    RayBatch rays;
    for (const Vec3& aside : {tangent, -tangent, bitangent, -bitangent})
        rays.push_back({surfel.position + offset * (aside + surfel.normal), -surfel.normal}, 0.0f);
    std::array<SurfaceHit, RayBatch::capacity> hits;
    surface.find_nearest(rays, 2.0f * offset, hits);
    for (std::size_t i = 0; i < rays.count; ++i) {
        if (!rays.hit[i])
            continue;
        const bool own = std::any_of(hits[i].vertices.begin(), hits[i].vertices.end(), [&](std::uint32_t v) {
            return v < mesh.positions.size() &&
                   glm::distance(frame.to_unit(mesh.positions[v]), surfel.position) < 0.5f * offset;
        });
        if (!own)
            return true;
    }
    return false;
}

std::string contact_warning(const BakeTarget& target, const RaySurface& surface) {
    const std::vector<Surfel> some = pick(target.surfels, evenly(spatial_order(target.surfels), max_surfels));
    const auto touching = std::count_if(some.begin(), some.end(), [&](const Surfel& surfel) {
        return lies_on_another_face(surfel, target.mesh, target.frame, surface, Exact::offset);
    });
    const double share = static_cast<double>(touching) / static_cast<double>(std::max<std::size_t>(some.size(), 1));
    constexpr double noticeable = 0.05;
    if (share < noticeable)
        return {};
    return fmt::format("{:.0f} % of the vertices lie on other faces, where occlusion is discontinuous: weld the mesh, "
                       "or move it away from what it touches",
                       100.0 * share);
}

}

std::vector<std::string> causes_of(double rmse, const BakeTarget& target, const BakeTask& task, const Method& method,
                                   const Occluders& occluders) {
    std::vector<std::string> warnings;
    const bool traces_field = method.needs_grid && !method.needs_mesh && method.samples_are == SampleKind::rays;
    if (rmse > thin_wall_rmse && traces_field)
        if (std::string warning = thin_walls_warning(target, occluders); !warning.empty())
            warnings.push_back(std::move(warning));
    if (rmse <= large_rmse || !warnings.empty())
        return warnings;
    const std::string measured = fmt::format("{} has an RMSE of {:.2g} here: ", method.name, rmse);
    if (target.radius < 10.0f * Exact::offset) {
        warnings.push_back(fmt::format("{}the radius is close to the offset of {:.3g} at which rays start: use a "
                                       "radius of {:.3g} or more",
                                       measured, double(Exact::offset) * target.frame.diagonal,
                                       10.0 * double(Exact::offset) * target.frame.diagonal));
        return warnings;
    }
    std::string cause = task.from_file_normals ? flipped_normals_warning(target) : "";
    if (cause.empty() && method.needs_grid)
        cause = thin_walls_warning(target, occluders);
    if (cause.empty())
        cause = contact_warning(target, occluders.rays());
    if (cause.empty() && task.error) // the caller says that the error is missed
        return warnings;
    if (cause.empty())
        cause = method.samples_are == SampleKind::rays
                    ? "use more --rays, or leave out --method to let the planner choose"
                    : "leave out --method to let the planner choose";
    warnings.push_back(measured + cause);
    return warnings;
}

std::string coarse_faces_warning(const BakeTarget& target, std::span<const float> ao, const RaySurface& rays) {
    constexpr float much_larger = 4.0f;
    constexpr std::size_t max_points = 1024;
    constexpr double noticeable = 0.05; // RMS difference
    if (ao.size() != target.mesh.vertex_count() || !std::isfinite(target.radius))
        return {};
    struct Large {
        const Triangle* triangle;
        double area;
    };
    std::vector<Large> large;
    double all_area = 0.0, large_area = 0.0;
    for (const Triangle& t : target.triangles) {
        const Vec3 a = target.frame.to_unit(target.mesh.positions[t[0]]),
                   b = target.frame.to_unit(target.mesh.positions[t[1]]),
                   c = target.frame.to_unit(target.mesh.positions[t[2]]);
        const double area = 0.5 * glm::length(glm::cross(b - a, c - a));
        all_area += area;
        if (std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)}) < much_larger * target.radius)
            continue;
        large.push_back({&t, area});
        large_area += area;
    }
    if (large_area < 0.1 * all_area || large_area <= 0.0)
        return {};
    // Points that each represent an equal share of the area, placed within each triangle by an additive recurrence
    // (Roberts 2018).
    std::vector<Surfel> points;
    std::vector<float> interpolated;
    double next = 0.5, before = 0.0;
    const double step = large_area / static_cast<double>(max_points);
    for (const Large& face : large) {
        const Triangle& t = *face.triangle;
        const Vec3 a = target.frame.to_unit(target.mesh.positions[t[0]]),
                   b = target.frame.to_unit(target.mesh.positions[t[1]]),
                   c = target.frame.to_unit(target.mesh.positions[t[2]]);
        const Vec3 normal = unit_or_zero(Vec3d(glm::cross(b - a, c - a)));
        for (before += face.area; next * step < before; next += 1.0) {
            double u = std::fmod(next * 0.7548776662466927, 1.0), v = std::fmod(next * 0.5698402909980532, 1.0);
            if (u + v > 1.0)
                u = 1.0 - u, v = 1.0 - v;
            if (normal == Vec3(0.0f))
                continue;
            const auto fu = static_cast<float>(u), fv = static_cast<float>(v);
            points.push_back({a + fu * (b - a) + fv * (c - a), normal});
            interpolated.push_back((1.0f - fu - fv) * ao[t[0]] + fu * ao[t[1]] + fv * ao[t[2]]);
        }
    }
    if (points.empty())
        return {};
    const std::vector<float> exact = evaluate_ao(points, rays, Exact{.radius = target.radius, .rays = 64});
    double squares = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
        squares += std::pow(double{exact[i]} - double{interpolated[i]}, 2);
    const double rms = std::sqrt(squares / static_cast<double>(points.size()));
    if (rms < noticeable)
        return {};
    return fmt::format("faces much larger than the radius cover {:.0f} % of the surface, and between their vertices "
                       "ao differs from its interpolation by {:.2g} (RMS): split them with --tessellate auto",
                       100.0 * large_area / all_area, rms);
}

}
