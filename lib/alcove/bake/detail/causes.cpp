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

/// The finest voxel that the user can request, unit space; infinite if the user has supplied the grid.
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
    constexpr double clearly = 0.98; // because the voxel is printed with three digits and must not be rounded up
    const double fine_enough = clearly * double(walls.voxel), diagonal = target.frame.diagonal;
    const std::string finer =
        fine_enough < finest_possible_voxel(target) ? "" : fmt::format("--voxel {:.3g}, or ", fine_enough * diagonal);
    return fmt::format("{:.1f} % of the vertices are on walls too thin for the voxel of {:.3g}, so rays through "
                       "the grid may miss them: use {}--method guided, which traces rays against the triangles",
                       100.0 * walls.share, double(resolution(field)) * diagonal, finer);
}

std::string contact_warning(const BakeTarget& target) {
    const auto touching = std::count_if(target.surfels.begin(), target.surfels.end(), [](const Surfel& surfel) {
        return surfel.covered || surfel.away != Vec3(0.0f);
    });
    const double share =
        static_cast<double>(touching) / static_cast<double>(std::max<std::size_t>(target.surfels.size(), 1));
    constexpr double noticeable = 0.05;
    if (share < noticeable)
        return {};
    return fmt::format(
        "{:.0f} % of the vertices touch other faces, where occlusion changes abruptly: weld the mesh, or "
        "use --method exact",
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
    std::string cause = method.needs_grid ? thin_walls_warning(target, occluders) : "";
    if (cause.empty())
        cause = contact_warning(target);
    if (cause.empty() && task.error) // the caller reports the missed error
        return warnings;
    if (cause.empty())
        cause = method.samples_are == SampleKind::rays && method.needs_mesh
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
    // Choose points that each represent an equal share of the area. An additive recurrence (Roberts 2018) places them
    // within the triangles.
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
    find_contacts(points, rays, ray_offset(target.radius));
    const std::vector<float> exact = evaluate_ao(points, rays, Exact{.radius = target.radius, .rays = 64});
    double squares = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
        squares += std::pow(double{exact[i]} - double{interpolated[i]}, 2);
    const double rms = std::sqrt(squares / static_cast<double>(points.size()));
    if (rms < noticeable)
        return {};
    return fmt::format("faces much larger than the radius cover {:.0f} % of the surface, and interpolating ao between "
                       "their vertices is off by {:.2g} (RMS): split them with --tessellate auto",
                       100.0 * large_area / all_area, rms);
}

}
