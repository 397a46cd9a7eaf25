#include "alcove/mesh/detail/clip.h"

#include <numeric>
#include <tuple>

namespace alcove {
namespace {

constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();

/// The intersection of an edge with the plane {p[axis] = at}, independent of the direction of the edge.
Vec3d cut(Vec3d a, Vec3d b, int axis, double at) {
    if (std::tie(b.x, b.y, b.z) < std::tie(a.x, a.y, a.z))
        std::swap(a, b);
    Vec3d p = a + (at - a[axis]) / (b[axis] - a[axis]) * (b - a);
    p[axis] = at;
    return p;
}

/// The part of a convex polygon on one side of the plane {p[axis] = at}.
std::vector<Vec3d> clip_side(const std::vector<Vec3d>& polygon, int axis, double at, bool above) {
    const auto inside = [&](const Vec3d& p) { return above ? p[axis] >= at : p[axis] <= at; };
    std::vector<Vec3d> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        if (inside(a))
            kept.push_back(a);
        if (inside(a) != inside(b))
            kept.push_back(cut(a, b, axis, at));
    }
    return kept;
}

}

Mesh clip(const Mesh& mesh, std::span<const Triangle> triangles, const Box& box) {
    Mesh result;
    std::vector<std::uint32_t> new_index(mesh.vertex_count(), unused), corners;
    std::vector<Vec3d> polygon;
    for (const Triangle& t : triangles) {
        Box around;
        for (const std::uint32_t v : t)
            around.add(mesh.positions[v]);
        if (glm::any(glm::greaterThan(around.min, box.max)) || glm::any(glm::lessThan(around.max, box.min)))
            continue;
        corners.clear();
        if (glm::all(glm::greaterThanEqual(around.min, box.min)) && glm::all(glm::lessThanEqual(around.max, box.max))) {
            for (const std::uint32_t v : t) {
                if (new_index[v] == unused) {
                    new_index[v] = static_cast<std::uint32_t>(result.vertex_count());
                    result.positions.push_back(mesh.positions[v]);
                }
                corners.push_back(new_index[v]);
            }
        } else {
            polygon.assign({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
            for (int axis = 0; axis < 3; ++axis) {
                polygon = clip_side(polygon, axis, box.min[axis], true);
                polygon = clip_side(polygon, axis, box.max[axis], false);
            }
            corners.resize(polygon.size());
            std::iota(corners.begin(), corners.end(), static_cast<std::uint32_t>(result.vertex_count()));
            result.positions.insert(result.positions.end(), polygon.begin(), polygon.end());
        }
        if (corners.size() >= 3)
            result.add_face(corners);
    }
    return result;
}

}
