#include "alcove/scene/missing_walls.h"

#include "alcove/occlusion/directions.h"
#include "alcove/occlusion/thin_walls.h"

#include <fmt/format.h>

#include <algorithm>

namespace alcove {
namespace {

/// Points on the faces, as evenly by area, in the unit space of a frame in the space of the prop.
std::vector<Surfel> points_on_faces(const Prop& prop, const Frame& own) {
    constexpr std::size_t count = 4096;
    const auto corner = [&](const Triangle& t, int i) {
        return (prop.mesh.positions[t[static_cast<std::size_t>(i)]] - own.center) / own.diagonal;
    };
    const auto cross = [&](const Triangle& t) {
        return glm::cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0));
    };
    double area = 0.0;
    for (const Triangle& t : prop.triangles)
        area += glm::length(cross(t));
    std::vector<Surfel> surfels;
    double before = 0.0;
    for (const Triangle& t : prop.triangles) {
        const Vec3d normal = cross(t);
        const double length = glm::length(normal);
        before += length;
        while (surfels.size() < count &&
               before * count > (static_cast<double>(surfels.size()) + 0.5) * area) {
            Vec2 place = recurrence_point(surfels.size(), 0);
            if (place.x + place.y > 1.0f)
                place = Vec2(1.0f) - place;
            const Vec3d a = corner(t, 0);
            const Vec3d p = a + double(place.x) * (corner(t, 1) - a) + double(place.y) * (corner(t, 2) - a);
            surfels.push_back({Vec3(p), Vec3(normal / length)});
        }
    }
    return surfels;
}

/// How many of the surfels have no inside on either side: normals may be the wrong way round.
double share_without_inside(const std::vector<Surfel>& surfels, const Prop& prop, const Frame& own,
                            const AnyField& field, const Frame& frame) {
    // Below what most edges are rounded by; walls of two voxels are whole there.
    const float depth = 0.25f * prop.stack.levels.front().voxel;
    const auto value = [&](const Surfel& surfel, float height) {
        return field.map(frame.to_unit(prop.pose(own.to_scene(surfel.position + height * surfel.normal))));
    };
    const auto without = std::count_if(surfels.begin(), surfels.end(), [&](const Surfel& surfel) {
        return value(surfel, -depth) > 0.0f && value(surfel, depth) > 0.0f;
    });
    return surfels.empty() ? 0.0 : static_cast<double>(without) / static_cast<double>(surfels.size());
}

}

std::string missing_walls(const Prop& prop, const AnyField& field, const Frame& frame,
                          const GridOptions& options) {
    constexpr double noticeable = 0.05, percent = 100.0;
    if (prop.stack.sign == Sign::sheet)
        return {};
    const Frame own = frame_of(prop.mesh.box());
    const std::vector<Surfel> surfels = points_on_faces(prop, own);
    const double share = share_without_inside(surfels, prop, own, field, frame);
    if (share < noticeable)
        return {};
    std::vector<Vec3> positions;
    positions.reserve(prop.mesh.positions.size());
    for (const Vec3d& p : prop.mesh.positions)
        positions.push_back(own.to_unit(p));
    const float voxel = prop.stack.levels.front().voxel;
    const ThinWalls walls = thin_walls(surfels, RaySurface(positions, prop.triangles), voxel, false);
    if (!walls.noticeable())
        return {};
    const double told = percent * double(walls.voxel);
    const double finest =
        finest_voxel(surface_size(prop.mesh, prop.triangles), prop.triangles.size(), options);
    return fmt::format(
        "walls, {:.0f} % of the surface, are too thin for the voxel of {:.3g}%, and have holes: {}",
        percent * share, percent * double(voxel),
        double(walls.voxel) >= finest
            ? fmt::format("use a voxel of {:.2g}%", told)
            : fmt::format("a voxel of {:.2g}%, which tells them, takes more memory than there is", told));
}

}
