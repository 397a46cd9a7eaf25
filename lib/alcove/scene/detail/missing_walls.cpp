#include "alcove/scene/detail/missing_walls.h"

#include "alcove/occlusion/detail/directions.h"
#include "alcove/occlusion/detail/thin_walls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

/// Points spread evenly by area over the faces, in the unit space of `own`, the frame of the mesh.
std::vector<Surfel> points_on_faces(const LoadedShape& loaded, const Frame& own) {
    constexpr std::size_t count = 4096;
    const auto corner = [&](const Triangle& t, int i) {
        return (loaded.mesh->mesh.positions[t[static_cast<std::size_t>(i)]] - own.center) / own.diagonal;
    };
    const auto cross = [&](const Triangle& t) {
        return glm::cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
    };
    double area = 0.0;
    for (const Triangle& t : loaded.mesh->triangles)
        area += glm::length(cross(t));
    std::vector<Surfel> surfels;
    double before = 0.0;
    for (const Triangle& t : loaded.mesh->triangles) {
        const Vec3d normal = cross(t);
        const double length = glm::length(normal);
        before += length;
        while (surfels.size() < count && before * count > (static_cast<double>(surfels.size()) + 0.5) * area) {
            Vec2 uv = recurrence_point(surfels.size(), 0);
            if (uv.x + uv.y > 1.0f)
                uv = Vec2(1.0f) - uv;
            const Vec3d a = corner(t, 0);
            const Vec3d p = a + double(uv.x) * (corner(t, 1) - a) + double(uv.y) * (corner(t, 2) - a);
            surfels.push_back({Vec3(p), Vec3(normal / length)});
        }
    }
    return surfels;
}

/// The share of the surfels where both sides of the surface are outside, according to the field. Checks both sides,
/// because normals may be flipped.
double share_without_inside(const std::vector<Surfel>& surfels, const LoadedShape& loaded, const Frame& own,
                            const AnyField& field, const Frame& frame) {
    // Walls of two voxels are intact at this depth, although the field rounds most edges off by more.
    const float depth = 0.25f * static_cast<float>(loaded.stack.levels.front().voxel);
    const auto value = [&](const Surfel& surfel, float height) {
        return field.map(frame.to_unit(loaded.pose(own.to_scene(surfel.position + height * surfel.normal))));
    };
    const auto without = std::count_if(surfels.begin(), surfels.end(), [&](const Surfel& surfel) {
        return value(surfel, -depth) > 0.0f && value(surfel, depth) > 0.0f;
    });
    return surfels.empty() ? 0.0 : static_cast<double>(without) / static_cast<double>(surfels.size());
}

}

std::string missing_walls(const LoadedShape& loaded, const AnyField& field, const Frame& frame,
                          const GridOptions& options) {
    constexpr double noticeable = 0.01, percent = 100.0;
    constexpr double resolved_by_floats = 1e-5; // smallest voxel, relative to the diagonal of the scene
    const Frame own = frame_of(loaded.mesh->mesh.box());
    const auto voxel = static_cast<float>(loaded.stack.levels.front().voxel);
    const bool resolved = double(voxel) * own.diagonal * loaded.pose.scale > resolved_by_floats * frame.diagonal;
    if (loaded.stack.sign == Sign::sheet || !resolved)
        return {};
    const std::vector<Surfel> points = points_on_faces(loaded, own);
    if (share_without_inside(points, loaded, own, field, frame) < noticeable)
        return {};
    std::vector<Vec3> positions;
    positions.reserve(loaded.mesh->mesh.positions.size());
    for (const Vec3d& p : loaded.mesh->mesh.positions)
        positions.push_back(own.to_unit(p));
    const RaySurface surface(positions, loaded.mesh->triangles);
    const ThinWalls walls = thin_walls(points, surface, voxel, false);
    // Near an edge, the distance to the far side is proportional to the distance to the edge. So at half the voxel,
    // edges contribute half the share, and cancel out in this difference.
    const double share = std::abs(2.0 * thin_walls(points, surface, 0.5f * voxel, false).share - walls.share);
    if (share < noticeable)
        return {};
    constexpr double rounding = 0.98; // the message rounds the voxel to three digits
    const double needed = rounding * double(walls.voxel);
    const double finest =
        finest_voxel(surface_size(loaded.mesh->mesh, loaded.mesh->triangles), loaded.mesh->triangles.size(), options);
    return fmt::format(
        "walls ({:.0f} % of the surface) are too thin for the voxel of {:.3g}% and have holes: {} a "
        "voxel of {:.3g}%{}",
        percent * share, percent * double(voxel), needed < finest ? "they need" : "use", percent * needed,
        needed < finest ? fmt::format(", which takes more than {:.2g} GB", options.memory_limit / 1e9) : std::string());
}

}
