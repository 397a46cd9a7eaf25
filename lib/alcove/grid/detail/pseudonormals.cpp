#include "alcove/grid/detail/pseudonormals.h"

#include "alcove/base/detail/closest_point.h"
#include "alcove/base/detail/morton_sort.h"
#include "alcove/base/parallel.h"
#include "alcove/mesh/detail/weld.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace alcove {
namespace {

float corner_angle(const Vec3d& at, const Vec3d& b, const Vec3d& c) {
    const Vec3d u = b - at, v = c - at;
    return static_cast<float>(std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v)));
}

}

Pseudonormals::Pseudonormals(std::span<const Vec3d> positions, std::span<const Triangle> triangles)
    : positions_(positions), triangles_(triangles), joined_(weld(positions)),
      face_normals_(triangles.size(), Vec3(0.0f)) {
    parallel_for(triangles_.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Triangle& t = triangles_[i];
            const Vec3d cross = glm::cross(positions_[t[1]] - positions_[t[0]], positions_[t[2]] - positions_[t[0]]);
            if (const double length = glm::length(cross); length > 0.0)
                face_normals_[i] = Vec3(cross / length);
        }
    });
    weight_normals();
}

void Pseudonormals::weight_normals() {
    vertex_normals_.assign(positions_.size(), Vec3(0.0f));
    const int bits = std::bit_width(positions_.size());
    HugeVector<Keyed<std::uint64_t>> half_edges; // the two vertices of each, and its index
    half_edges.reserve(triangles_.size() * 3);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        check_cancelled();
        if (face_normals_[t] == Vec3(0.0f))
            continue;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const Triangle& tri = triangles_[t];
            const std::uint32_t at = tri[k], next = tri[(k + 1) % 3], last = tri[(k + 2) % 3];
            vertex_normals_[joined_[at]] +=
                corner_angle(positions_[at], positions_[next], positions_[last]) * face_normals_[t];
            const auto [low, high] = std::minmax(joined_[at], joined_[next]);
            const auto slot = static_cast<std::uint32_t>(3 * t + k);
            half_edges.push_back({std::uint64_t{low} << bits | high, slot});
        }
    }
    radix_sort(half_edges, 0, 2 * bits);

    edge_normals_.assign(3 * triangles_.size(), Vec3(0.0f));
    std::vector<std::uint32_t> boundary;
    for (std::size_t begin = 0, end = 0; begin < half_edges.size(); begin = end) {
        Vec3 sum(0.0f);
        for (end = begin; end < half_edges.size() && half_edges[end].key == half_edges[begin].key; ++end)
            sum += face_normals_[half_edges[end].value / 3];
        if (end == begin + 1) {
            sum = Vec3(0.0f);
            boundary.push_back(static_cast<std::uint32_t>(half_edges[begin].key >> bits));
            boundary.push_back(static_cast<std::uint32_t>(half_edges[begin].key & ((std::uint64_t{1} << bits) - 1)));
        }
        for (std::size_t i = begin; i < end; ++i)
            edge_normals_[half_edges[i].value] = sum;
    }
    for (const std::uint32_t v : boundary)
        vertex_normals_[v] = Vec3(0.0f);
}

double Pseudonormals::side(std::size_t triangle, const Vec3d& p) const {
    const Triangle& t = triangles_[triangle];
    const auto [offset, feature] = closest_on_triangle(positions_[t[0]], positions_[t[1]], positions_[t[2]], p);
    const auto corner = static_cast<std::size_t>(feature) % 3;
    const Vec3 normal = feature == face_feature ? face_normals_[triangle]
                        : feature < 3           ? vertex_normals_[joined_[t[corner]]]
                                                : edge_normals_[3 * triangle + corner];
    return glm::dot(offset, Vec3d(normal));
}

}
