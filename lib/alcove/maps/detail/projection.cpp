#include "alcove/maps/detail/projection.h"

#include "alcove/base/parallel.h"
#include "alcove/field/detail/trace.h"
#include "alcove/mesh/detail/corner_normals.h"
#include "alcove/mesh/normals.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/occlusion/detail/directions.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace alcove {
namespace {

RaySurface split_surface(const Mesh& mesh, const std::vector<Triangle>& triangles, const Frame& frame) {
    std::vector<Vec3> positions;
    std::vector<Triangle> split;
    positions.reserve(3 * triangles.size());
    for (const Triangle& t : triangles) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        for (const std::uint32_t v : t)
            positions.push_back(frame.to_unit(mesh.positions[v]));
        split.push_back({first, first + 1, first + 2});
    }
    return {positions, split};
}

}

Projection::Projection(const Mesh& high, NormalSource normals)
    : mesh_(high), frame_(frame_of(high.box())), triangles_(triangulate(high).triangles),
      faces_(faces_of_triangles(high)), normals_(corner_normals(high, triangles_, normals)),
      surface_(split_surface(high, triangles_, frame_)) {}

std::vector<ProjectedTo> Projection::project(std::span<const ProjectedFrom> points, double behind) const {
    std::vector<ProjectedTo> to(points.size());
    parallel_for(points.size(), RayBatch::capacity, [&](std::size_t begin, std::size_t end) {
        // A ray that meets an edge may miss the faces on both sides of it, so rays beside it are tried too.
        constexpr float beside = 1e-5f; // unit space
        for (const Vec2 shift : {Vec2(0, 0), Vec2(beside, 0), Vec2(-beside, 0), Vec2(0, beside), Vec2(0, -beside)})
            project_block(points.subspan(begin, end - begin), behind, shift, std::span(to).subspan(begin, end - begin));
    });
    return to;
}

void Projection::project_block(std::span<const ProjectedFrom> points, double behind, const Vec2& shift,
                               std::span<ProjectedTo> to) const {
    constexpr int most_back_faces = 16;
    double furthest = 0.0;
    for (const ProjectedFrom& point : points)
        furthest = std::max(furthest, point.front + behind);
    RayBatch rays;
    std::array<std::size_t, RayBatch::capacity> owner;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (points[i].direction != Vec3(0.0f) && !to[i].hit) {
            owner[rays.count] = i;
            const Basis basis(points[i].direction);
            const Vec3 start = frame_.to_unit(points[i].position + points[i].front * Vec3d(points[i].direction));
            rays.push_back({start + shift.x * basis.tangent + shift.y * basis.bitangent, -points[i].direction}, 0.0f);
        }
    std::array<SurfaceHit, RayBatch::capacity> hits;
    for (int pass = 0; pass < most_back_faces && rays.count > 0; ++pass) {
        surface_.find_nearest(rays, static_cast<float>(furthest / frame_.diagonal), hits);
        RayBatch left; // rays that met a back face
        for (std::size_t r = 0; r < rays.count; ++r) {
            if (!rays.hit[r])
                continue;
            const std::size_t i = owner[r];
            const double travelled = double(rays.travelled[r]) * frame_.diagonal;
            if (travelled > points[i].front + behind)
                continue;
            const Vec3 inward(rays.dx[r], rays.dy[r], rays.dz[r]);
            if (glm::dot(hits[r].normal, inward) >= 0.0f) {
                constexpr float step = 1e-6f;
                owner[left.count] = i;
                left.push_back({{rays.x[r], rays.y[r], rays.z[r]}, inward}, rays.travelled[r] + step);
                continue;
            }
            const std::uint32_t triangle = hits[r].vertices[0] / 3;
            ProjectedTo& result = to[i];
            result.hit = true;
            result.height = static_cast<float>(points[i].front - travelled);
            result.point.face = faces_[triangle];
            result.point.position = Vec3d(0.0);
            Vec3d normal(0.0);
            for (std::size_t k = 0; k < 3; ++k) {
                const double weight = hits[r].weights[static_cast<int>(k)];
                result.point.position += weight * mesh_.positions[triangles_[triangle][k]];
                normal += weight * Vec3d(normals_[triangle][k]);
            }
            result.point.normal = unit_or_zero(normal);
        }
        rays = left;
    }
}

double Projection::reach_for(std::span<const ProjectedFrom> points) const {
    constexpr double furthest = 0.1, least = 1e-4; // relative to the diagonal
    constexpr double most = 0.95, spare = 5.0;     // rays past a tip hit other parts, far away
    std::vector<ProjectedFrom> inverse(points.begin(), points.end());
    for (ProjectedFrom& point : inverse)
        point.direction = -point.direction;
    // A ray from far in front would meet other parts first, so rays start at the points and go in both directions.
    std::vector<double> distances;
    for (const std::span<const ProjectedFrom> from : {points, std::span<const ProjectedFrom>(inverse)}) {
        std::vector<double> nearest(from.size(), std::numeric_limits<double>::infinity());
        parallel_for(from.size(), RayBatch::capacity, [&](std::size_t begin, std::size_t end) {
            RayBatch rays;
            std::array<SurfaceHit, RayBatch::capacity> hits;
            std::array<std::size_t, RayBatch::capacity> owner;
            for (std::size_t i = begin; i < end; ++i)
                if (from[i].direction != Vec3(0.0f)) {
                    owner[rays.count] = i;
                    rays.push_back({frame_.to_unit(from[i].position), from[i].direction}, 0.0f);
                }
            surface_.find_nearest(rays, static_cast<float>(furthest), hits);
            for (std::size_t r = 0; r < rays.count; ++r)
                if (rays.hit[r])
                    nearest[owner[r]] = rays.travelled[r];
        });
        if (distances.empty())
            distances = std::move(nearest);
        else
            for (std::size_t i = 0; i < nearest.size(); ++i)
                distances[i] = std::min(distances[i], nearest[i]);
    }
    std::erase_if(distances, [](double distance) { return !std::isfinite(distance); });
    if (distances.empty())
        return furthest * frame_.diagonal;
    const auto place = static_cast<std::ptrdiff_t>(most * static_cast<double>(distances.size() - 1));
    std::nth_element(distances.begin(), distances.begin() + place, distances.end());
    return std::max(spare * distances[static_cast<std::size_t>(place)], least) * frame_.diagonal;
}

}
