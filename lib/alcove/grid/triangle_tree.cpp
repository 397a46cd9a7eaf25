#include "alcove/grid/triangle_tree.h"

#include "alcove/huge_pages.h"
#include "alcove/parallel.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

constexpr int eight = 8;
static_assert(TriangleGroup::size == eight && BoundsGroup::size == eight);
// Floats at the far end of the grid are this coarse, relatively; bounds are widened by it.
constexpr float rounding = 0x1p-21f;
constexpr float nowhere = 1e18f; // its square is finite

struct Cylinder {
    Vec3 centre, axis, point;
    float thickness, radius;
};

Vec3 lane(const float (&v)[3][eight], int i) {
    return {v[0][i], v[1][i], v[2][i]};
}

void set_lane(float (&v)[3][eight], int i, const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis)
        v[axis][i] = p[axis];
}

float length2(const Vec3& v) {
    return glm::dot(v, v);
}

Vec3 unit_or_z(const Vec3& v) {
    const float length = glm::length(v);
    return length > 0.0f ? v / length : Vec3(0, 0, 1);
}

TriangleGroup group_of(std::span<const Piece> pieces) {
    TriangleGroup group;
    group.origin = pieces[0].origin;
    group.count = static_cast<std::uint32_t>(pieces.size());
    for (int i = 0; i < eight; ++i) {
        const Piece& p =
            pieces[static_cast<std::size_t>(i) < pieces.size() ? static_cast<std::size_t>(i) : 0];
        set_lane(group.a, i, Vec3(p.origin - group.origin) + p.corners[0]);
        set_lane(group.ab, i, p.corners[1] - p.corners[0]);
        set_lane(group.ac, i, p.corners[2] - p.corners[0]);
        group.triangle[i] = p.triangle;
    }
    return group;
}

Cylinder widened(Cylinder c) {
    const float most = std::max({c.centre.x, c.centre.y, c.centre.z, 1.0f});
    c.thickness += rounding * most;
    c.radius += rounding * most;
    return c;
}

float least_of(const float (&v)[eight]) {
    return *std::min_element(v, v + eight);
}

float most_of(const float (&v)[eight]) {
    return *std::max_element(v, v + eight);
}

/// Loops over the eight are the inner ones, which compilers turn into vectors.
Cylinder bounds_of(const TriangleGroup& g) {
    const float(*const a)[eight] = g.a;
    Cylinder result;
    float corners[3][3][eight]; // corner, axis
    for (int axis = 0; axis < 3; ++axis) {
        float least[eight], most[eight];
        for (int i = 0; i < eight; ++i) {
            const float p = a[axis][i], q = p + g.ab[axis][i], r = p + g.ac[axis][i];
            corners[0][axis][i] = p;
            corners[1][axis][i] = q;
            corners[2][axis][i] = r;
            least[i] = std::min(p, std::min(q, r));
            most[i] = std::max(p, std::max(q, r));
        }
        result.centre[axis] = 0.5f * (least_of(least) + most_of(most));
    }
    Vec3 normal(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        float area[eight];
        for (int i = 0; i < eight; ++i)
            area[i] = g.ab[u][i] * g.ac[v][i] - g.ab[v][i] * g.ac[u][i];
        for (const float part : area)
            normal[axis] += part;
    }
    result.axis = unit_or_z(normal);

    const Vec3 n = result.axis, m = result.centre;
    float low[eight], high[eight], across2[eight];
    std::fill_n(low, eight, nowhere);
    std::fill_n(high, eight, -nowhere);
    std::fill_n(across2, eight, 0.0f);
    for (const auto& corner : corners)
        for (int i = 0; i < eight; ++i) {
            const float x = corner[0][i] - m.x, y = corner[1][i] - m.y, z = corner[2][i] - m.z;
            const float h = n.x * x + n.y * y + n.z * z;
            low[i] = std::min(low[i], h);
            high[i] = std::max(high[i], h);
            const float px = x - h * n.x, py = y - h * n.y, pz = z - h * n.z;
            across2[i] = std::max(across2[i], px * px + py * py + pz * pz);
        }
    const float bottom = least_of(low), top = most_of(high);
    const auto third = [&](int i) { return lane(g.a, i) + (lane(g.ab, i) + lane(g.ac, i)) / 3.0f; };
    result.point = third(0);
    for (int i = 1; i < eight; ++i)
        if (const Vec3 p = third(i); length2(p - m) < length2(result.point - m))
            result.point = p;
    result.point += Vec3(g.origin);
    result.centre += 0.5f * (bottom + top) * n + Vec3(g.origin);
    result.thickness = 0.5f * (top - bottom);
    result.radius = std::sqrt(most_of(across2));
    return widened(result);
}

Cylinder bounds_of(const BoundsGroup& g) {
    Vec3 least(nowhere), most(-nowhere), normal(0.0f);
    for (int i = 0; i < eight && g.radius[i] >= 0.0f; ++i) {
        const Vec3 centre = lane(g.centre, i);
        least = glm::min(least, centre - g.radius[i]);
        most = glm::max(most, centre + g.radius[i]);
        normal += g.radius[i] * g.radius[i] * lane(g.axis, i);
    }
    Cylinder result{0.5f * (least + most), unit_or_z(normal), lane(g.point, 0), 0.0f, 0.0f};
    float low = nowhere, high = -nowhere;
    for (int i = 0; i < eight && g.radius[i] >= 0.0f; ++i) {
        const Vec3 way = lane(g.centre, i) - result.centre;
        const float height = glm::dot(way, result.axis);
        const float cosine = std::min(1.0f, std::fabs(glm::dot(lane(g.axis, i), result.axis)));
        const float sine = std::sqrt(1.0f - cosine * cosine);
        const float half = cosine * g.thickness[i] + sine * g.radius[i];
        if (const Vec3 p = lane(g.point, i);
            length2(p - result.centre) < length2(result.point - result.centre))
            result.point = p;
        low = std::min(low, height - half);
        high = std::max(high, height + half);
        result.radius = std::max(result.radius, glm::length(way - height * result.axis) + g.radius[i] +
                                                    sine * g.thickness[i]);
    }
    result.centre += 0.5f * (low + high) * result.axis;
    result.thickness = 0.5f * (high - low);
    return widened(result);
}

/// A level of bounds over the `count` nodes from `first` on.
template <class Node>
void add_level(std::vector<BoundsGroup>& bounds, std::size_t at, const Node* nodes, std::size_t first,
               std::size_t count) {
    parallel_for((count + eight - 1) / eight, 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t group = begin; group < end; ++group)
            for (int i = 0; i < eight; ++i) {
                const std::size_t child = eight * group + static_cast<std::size_t>(i);
                BoundsGroup& b = bounds[at + group];
                Cylinder c{Vec3(nowhere), Vec3(0, 0, 1), Vec3(nowhere), 0.0f, -1.0f};
                if (child < count)
                    c = bounds_of(nodes[child]);
                set_lane(b.centre, i, c.centre);
                set_lane(b.axis, i, c.axis);
                set_lane(b.point, i, c.point);
                b.thickness[i] = c.thickness;
                b.radius[i] = c.radius;
                b.child[i] = static_cast<std::uint32_t>(first + child);
            }
    });
}

}

TriangleTree::TriangleTree(const GroupedPieces& grouped) {
    const auto groups_of = [](std::size_t count) { return (count + eight - 1) / eight; };
    triangles = huge_vector<TriangleGroup>(grouped.begin.size() - 1);
    parallel_for(triangles.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end; ++g)
            triangles[g] = group_of(
                std::span(grouped.pieces).subspan(grouped.begin[g], grouped.begin[g + 1] - grouped.begin[g]));
    });
    std::size_t total = 0;
    for (std::size_t level = triangles.size(); level > 1 || total == 0;) {
        level = groups_of(level);
        total += level;
    }
    bounds = huge_vector<BoundsGroup>(total);
    std::size_t count = groups_of(triangles.size());
    add_level(bounds, 0, triangles.data(), 0, triangles.size());
    leaves = static_cast<std::uint32_t>(count);
    for (std::size_t first = 0; count > 1;) {
        const std::size_t next = first + count;
        add_level(bounds, next, bounds.data() + first, first, count);
        first = next;
        count = groups_of(count);
    }
}

}
