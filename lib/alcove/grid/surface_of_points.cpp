#include "alcove/base/detail/messages.h"
#include "alcove/base/parallel.h"
#include "alcove/grid/detail/point_cloud.h"
#include "alcove/grid/detail/point_field.h"
#include "alcove/grid/voxelize.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

constexpr float voxels_per_spacing = 0.9f, most_voxels_per_spacing = 3.0f;

std::vector<std::string> warnings_of(const PointCloud& cloud) {
    std::vector<std::string> warnings;
    if (cloud.outliers > 0)
        warnings.push_back(counted(cloud.outliers, "point is an outlier", "points are outliers") +
                           " far from the others; left out");
    if (!cloud.duplicates.empty())
        warnings.push_back(counted(cloud.duplicates.size(), "point repeats", "points repeat") +
                           " the position of another");
    if (cloud.not_finite > 0)
        warnings.push_back(counted(cloud.not_finite, "point has", "points have") +
                           " coordinates that are not finite numbers; left out");
    if (cloud.estimated_normals > 0)
        warnings.push_back(fmt::format("{} no normal, so it was estimated from neighbours and may point the wrong way: "
                                       "export the points with normals",
                                       counted(cloud.estimated_normals, "point has", "points have")));
    return warnings;
}

/// Warns if points are much denser than the voxel, which is then too coarse for their detail.
void warn_of_detail(const PointCloud& cloud, float voxel, std::vector<std::string>& warnings) {
    constexpr float dense = 0.125f;        // spacings per voxel
    constexpr float least_spacing = 2e-6f; // floats in unit space resolve no less
    const auto lost =
        static_cast<std::size_t>(std::count_if(cloud.points.begin(), cloud.points.end(),
                                               [&](const CloudPoint& point) { return point.spacing < dense * voxel; }));
    constexpr std::size_t few = 100;
    if (cloud.spacing < least_spacing)
        warnings.emplace_back(
            "the points extend so far, compared with their spacing, that their positions are rounded: "
            "bake the parts of the scene one at a time");
    else if (lost > cloud.points.size() / few)
        warnings.push_back(fmt::format("{} much closer together than the others, and detail of that size is lost: bake "
                                       "them on their own, or give a smaller --point-size",
                                       counted(lost, "point is", "points are")));
}

void warn_of_size(const PointCloud& cloud, float size, std::vector<std::string>& warnings) {
    constexpr float far_off = 5.0f;
    if (size > far_off * cloud.spacing || size < cloud.spacing / far_off)
        warnings.push_back(
            fmt::format("--point-size is {:.2g} times the distance between neighbouring points, which is "
                        "{:.2g} of the diagonal: leave it out, or give a length close to that distance",
                        size / cloud.spacing, cloud.spacing));
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
    if (options.point_size && !std::isfinite(options.point_size->value))
        fail("--point-size takes a finite length: write 0.2 (scene units) or 0.1%");
    std::vector<std::string> warnings = warnings_of(cloud);
    if (options.point_size) {
        warn_of_size(cloud, options.point_size->to_unit(frame.diagonal), warnings);
        cloud.spacing = options.point_size->to_unit(frame.diagonal);
        for (CloudPoint& point : cloud.points)
            point.spacing = cloud.spacing;
    }
    const float voxel =
        std::clamp(options.least_voxel, voxels_per_spacing * cloud.spacing, most_voxels_per_spacing * cloud.spacing);
    const PointField field(cloud, voxel);
    PointSurface result;
    result.mesh = field.surface();
    if (result.mesh.face_count() == 0)
        fail("the points determine no surface: their normals contradict each other, or --point-size is too small");
    for (Vec3d& p : result.mesh.positions)
        p = p * frame.diagonal + frame.center;
    result.mesh.name = points.name;
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
    const auto lost =
        static_cast<std::size_t>(std::count_if(cloud.points.begin(), cloud.points.end(), [&](const CloudPoint& point) {
            return result.normals[point.source] == Vec3(0.0f);
        }));
    constexpr std::size_t few = 100; // at borders and corners, losing one point in a hundred is to be expected
    if (lost > cloud.points.size() / few)
        warnings.push_back(counted(lost, "point has", "points have") +
                           " no surface and got ao = 1: their neighbours are too far away; give a larger --point-size");
    warn_of_detail(cloud, voxel, warnings);
    result.mesh.warnings = std::move(warnings);
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
