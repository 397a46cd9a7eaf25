#include "alcove/base/detail/messages.h"
#include "alcove/base/parallel.h"
#include "alcove/grid/detail/point_cloud.h"
#include "alcove/grid/detail/point_field.h"
#include "alcove/grid/voxelize.h"

#include <fmt/format.h>

#include <algorithm>

namespace alcove {
namespace {

constexpr float voxels_per_spacing = 0.9f;

std::vector<std::string> warnings_of(const PointCloud& cloud) {
    std::vector<std::string> warnings;
    if (cloud.outliers > 0)
        warnings.push_back(counted(cloud.outliers, "point is an outlier", "points are outliers") +
                           " far from the others; left out");
    if (!cloud.duplicates.empty())
        warnings.push_back(counted(cloud.duplicates.size(), "point repeats", "points repeat") +
                           " the place of another");
    if (cloud.not_finite > 0)
        warnings.push_back(counted(cloud.not_finite, "point has", "points have") +
                           " coordinates that are not finite numbers; left out");
    if (cloud.estimated_normals > 0)
        warnings.push_back(
            fmt::format("{} no normal, so it was estimated from neighbours; which side is out is a guess: "
                        "export the points with normals",
                        counted(cloud.estimated_normals, "point has", "points have")));
    return warnings;
}

}

PointSurface surface_of_points(const Mesh& points, const PointOptions& options) {
    const auto fail = [&](const std::string& message) {
        throw InputError((points.name.empty() ? "" : points.name + ": ") + message);
    };
    const Frame frame = frame_of(box_without_outliers(points.positions));
    PointCloud cloud;
    try {
        cloud = clean_points(points.positions, points.normals, frame);
    } catch (const InputError& error) {
        fail(error.what());
    }
    if (options.point_size) {
        cloud.spacing = options.point_size->to_unit(frame.diagonal);
        for (CloudPoint& point : cloud.points)
            point.spacing = cloud.spacing;
    }
    const PointField field(cloud, std::max(voxels_per_spacing * cloud.spacing, options.least_voxel));
    PointSurface result;
    result.mesh = field.surface();
    if (result.mesh.face_count() == 0)
        fail("the points determine no surface: their normals contradict each other, or --point-size is too small");
    for (Vec3d& p : result.mesh.positions)
        p = p * frame.diagonal + frame.center;
    result.mesh.name = points.name;
    result.mesh.warnings = warnings_of(cloud);
    result.positions.assign(points.vertex_count(), Vec3d(0.0));
    result.normals.assign(points.vertex_count(), Vec3(0.0f));
    result.faces.assign(points.vertex_count(), 0);
    parallel_for(cloud.points.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (const std::optional<PointField::Place> place = field.closest(cloud.points[i].position)) {
                result.positions[cloud.points[i].source] = place->position * frame.diagonal + frame.center;
                result.faces[cloud.points[i].source] = place->face;
                result.normals[cloud.points[i].source] = cloud.points[i].normal;
            }
    });
    for (const auto& [point, other] : cloud.duplicates) {
        result.positions[point] = result.positions[other];
        result.normals[point] = result.normals[other];
        result.faces[point] = result.faces[other];
    }
    return result;
}

Mesh with_surface(Mesh mesh, const PointOptions& options) {
    if (mesh.face_count() > 0)
        return mesh;
    Mesh surface = surface_of_points(mesh, options).mesh;
    surface.warnings.insert(surface.warnings.begin(), mesh.warnings.begin(), mesh.warnings.end());
    return surface;
}

}
