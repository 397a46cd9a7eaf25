#include "alcove/maps/detail/tangent_frames.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

namespace alcove {
namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

using Corners = std::array<TangentCorner, 3>;

Vec3d unit(const Vec3d& v) {
    const double length = glm::length(v);
    return length > 0.0 ? v / length : Vec3d(0.0);
}

/// The component of a vector at right angles to a normal, normalised.
Vec3d projected(const Vec3d& v, const Vec3d& normal) {
    return unit(v - glm::dot(normal, v) * normal);
}

/// The direction of u on a triangle, and whether its UVs keep the orientation. The triangle is degenerate if its UVs
/// have no area, or if u or v has no direction on it.
struct Gradient {
    Vec3d along_u{0.0};
    bool keeps_orientation = false, is_degenerate = true;

    explicit Gradient(const Corners& c) {
        const glm::dvec2 t1 = glm::dvec2(c[1].uv) - glm::dvec2(c[0].uv), t2 = glm::dvec2(c[2].uv) - glm::dvec2(c[0].uv);
        const Vec3d d1 = c[1].position - c[0].position, d2 = c[2].position - c[0].position;
        const double area = t1.x * t2.y - t1.y * t2.x;
        keeps_orientation = area > 0.0;
        const Vec3d u = t2.y * d1 - t1.y * d2, v = -t2.x * d1 + t1.x * d2;
        along_u = (keeps_orientation ? 1.0 : -1.0) * unit(u);
        is_degenerate = area == 0.0 || u == Vec3d(0.0) || v == Vec3d(0.0);
    }
};

/// Numbers the corners. Corners with the same position, normal and UV get the same number.
std::vector<std::uint32_t> vertices_of(std::span<const Corners> triangles) {
    std::vector<std::uint32_t> order(3 * triangles.size()), vertices(order.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t i) {
        const TangentCorner& c = triangles[i / 3][i % 3];
        return std::tuple(c.position.x, c.position.y, c.position.z, c.normal.x, c.normal.y, c.normal.z, c.uv.x, c.uv.y);
    };
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
    for (std::size_t i = 0; i < order.size(); ++i)
        vertices[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? vertices[order[i - 1]] : order[i];
    return vertices;
}

/// Finds the neighbour across each edge. An edge runs from the corner with its number to the next corner. Its entry in
/// the result is the corner of the neighbour from which the same edge runs back.
std::vector<std::uint32_t> neighbours_of(const std::vector<std::uint32_t>& vertices) {
    const auto end_of = [&](std::uint32_t edge) { return vertices[edge % 3 == 2 ? edge - 2 : edge + 1]; };
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> open; // unpaired edges, by their ends
    std::vector<std::uint32_t> neighbours(vertices.size(), none);
    for (std::uint32_t edge = 0; edge < vertices.size(); ++edge) {
        const std::pair ends(vertices[edge], end_of(edge));
        if (const auto back = open.find({ends.second, ends.first}); back != open.end() && !back->second.empty()) {
            neighbours[edge] = back->second.front();
            neighbours[back->second.front()] = edge;
            back->second.erase(back->second.begin());
        } else {
            open[ends].push_back(edge);
        }
    }
    return neighbours;
}

class TangentGroups {
  public:
    explicit TangentGroups(std::span<const Corners> triangles)
        : triangles_(triangles), vertices_(vertices_of(triangles)), neighbours_(neighbours_of(vertices_)),
          tangents_(vertices_.size(), Vec3d(1.0, 0.0, 0.0)), has_group_(vertices_.size(), 0) {
        for (const Corners& corners : triangles)
            gradients_.emplace_back(corners);
    }

    std::vector<TangentTriangle> frames() {
        for (std::uint32_t corner = 0; corner < vertices_.size(); ++corner)
            if (!gradients_[corner / 3].is_degenerate && !has_group_[corner])
                add_group(corner);
        std::vector<TangentTriangle> frames(triangles_.size());
        for (std::size_t t = 0; t < frames.size(); ++t) {
            for (std::size_t k = 0; k < 3; ++k)
                frames[t].tangents[k] = Vec3(tangents_[3 * t + k]);
            frames[t].sign = gradients_[t].keeps_orientation ? 1.0f : -1.0f;
        }
        return frames;
    }

  private:
    /// Sets the tangent of the group of corners around a vertex that are connected by edges and equally mirrored.
    void add_group(std::uint32_t first) {
        const bool orientation = gradients_[first / 3].keeps_orientation;
        std::vector<std::uint32_t> group{first};
        has_group_[first] = 1;
        for (std::size_t i = 0; i < group.size(); ++i) {
            const std::uint32_t corner = group[i], triangle = corner / 3 * 3,
                                previous = triangle + (corner % 3 + 2) % 3;
            // The neighbour across the edge that begins here has an edge that ends at the vertex. The neighbour across
            // the edge that ends here has an edge that begins at the vertex.
            if (const std::uint32_t back = neighbours_[corner]; back != none)
                visit(back / 3 * 3 + (back % 3 + 1) % 3, orientation, group);
            if (const std::uint32_t back = neighbours_[previous]; back != none)
                visit(back, orientation, group);
        }
        Vec3d sum(0.0);
        for (const std::uint32_t corner : group)
            sum += weighted_tangent(corner);
        for (const std::uint32_t corner : group)
            tangents_[corner] = unit(sum);
    }

    void visit(std::uint32_t corner, bool orientation, std::vector<std::uint32_t>& group) {
        Gradient& gradient = gradients_[corner / 3];
        if (gradient.is_degenerate && !has_orientation(corner / 3)) // takes the orientation of the first group
            gradient.keeps_orientation = orientation;
        if (has_group_[corner] || gradient.keeps_orientation != orientation)
            return;
        has_group_[corner] = 1;
        group.push_back(corner);
    }

    bool has_orientation(std::size_t triangle) const {
        return has_group_[3 * triangle] || has_group_[3 * triangle + 1] || has_group_[3 * triangle + 2];
    }

    Vec3d weighted_tangent(std::uint32_t corner) const {
        const Corners& c = triangles_[corner / 3];
        if (gradients_[corner / 3].is_degenerate)
            return Vec3d(0.0);
        const std::size_t k = corner % 3;
        const Vec3d normal(c[k].normal), at = c[k].position;
        const Vec3d a = projected(c[(k + 2) % 3].position - at, normal),
                    b = projected(c[(k + 1) % 3].position - at, normal);
        return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)) * projected(gradients_[corner / 3].along_u, normal);
    }

    std::span<const Corners> triangles_;
    std::vector<std::uint32_t> vertices_, neighbours_; // by corner
    std::vector<Gradient> gradients_;                  // by triangle
    std::vector<Vec3d> tangents_;                      // by corner; initial value if the corner is in no group
    std::vector<std::uint8_t> has_group_;
};

}

std::vector<TangentTriangle> tangent_frames(std::span<const Corners> triangles) {
    return TangentGroups(triangles).frames();
}

}
