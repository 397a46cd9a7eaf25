#include "alcove/grid/triangle_tree.h"

#include "alcove/parallel.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

constexpr int eight = 8;
static_assert(TriangleGroup::size == eight && TriangleTree::children == eight);
// Floats at the far end of the grid are this coarse, relatively; bounds are widened by it.
constexpr float rounding = 0x1p-21f;
constexpr float nowhere = 1e18f; // its square is finite

float length2(const Vec3& v) {
    return glm::dot(v, v);
}

Vec3 unit_or_z(const Vec3& v) {
    const float length = glm::length(v);
    return length > 0.0f ? v / length : Vec3(0, 0, 1);
}

/// The corners of eight triangles from the origin of their group; loops over the eight are the inner ones, which
/// compilers turn into vectors.
struct Corners {
    float a[3][eight], ab[3][eight], ac[3][eight];
};

using Eight = float[eight];

void dot(const float (&p)[3][eight], const float (&q)[3][eight], Eight& out) {
    for (int i = 0; i < eight; ++i)
        out[i] = p[0][i] * q[0][i] + p[1][i] * q[1][i] + p[2][i] * q[2][i];
}

float inverse(float v) {
    return 1.0f / std::max(v, 1e-30f); // rather than of the length of a side that has none
}

void set_frames(const Corners& corners, TriangleGroup& g) {
    const auto& [a, ab, ac] = corners;
    Eight ab2, ac2, along, height2, has_height;
    dot(ab, ab, ab2);
    dot(ac, ac, ac2);
    for (int i = 0; i < eight; ++i) {
        g.b[i] = std::sqrt(ab2[i]);
        const float scale = inverse(g.b[i]);
        g.u[0][i] = ab2[i] > 0.0f ? scale * ab[0][i] : 1.0f;
        g.u[1][i] = scale * ab[1][i];
        g.u[2][i] = scale * ab[2][i];
    }
    // The height of c, made perpendicular once more: the first time leaves rounding of the size of the sides.
    float height[3][eight];
    std::copy_n(&ac[0][0], 3 * eight, &height[0][0]);
    for (int pass = 0; pass < 2; ++pass) {
        dot(height, g.u, along);
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < eight; ++i)
                height[axis][i] -= along[i] * g.u[axis][i];
    }
    dot(height, height, height2);
    for (int i = 0; i < eight; ++i) {
        const bool flat = height2[i] <= 1e-12f * ac2[i]; // then any direction across u will do
        const float x = g.u[0][i], y = g.u[1][i], z = g.u[2][i];
        const bool steep = std::fabs(z) > 0.6f;
        const float side = inverse(std::sqrt(x * x + (steep ? z * z : y * y)));
        const float scale = inverse(std::sqrt(height2[i]));
        g.v[0][i] = flat ? side * (steep ? -z : -y) : scale * height[0][i];
        g.v[1][i] = flat ? (steep ? 0.0f : side * x) : scale * height[1][i];
        g.v[2][i] = flat ? (steep ? side * x : 0.0f) : scale * height[2][i];
        has_height[i] = flat ? 0.0f : 1.0f;
    }
    dot(ac, g.u, g.c[0]);
    dot(ac, g.v, g.c[1]);
    for (int i = 0; i < eight; ++i) {
        g.n[0][i] = g.u[1][i] * g.v[2][i] - g.u[2][i] * g.v[1][i];
        g.n[1][i] = g.u[2][i] * g.v[0][i] - g.u[0][i] * g.v[2][i];
        g.n[2][i] = g.u[0][i] * g.v[1][i] - g.u[1][i] * g.v[0][i];
        g.c[1][i] *= has_height[i];
        const float c0 = g.c[0][i], c1 = g.c[1][i], bc0 = c0 - g.b[i];
        const float per_ac = inverse(c0 * c0 + c1 * c1), per_bc = inverse(bc0 * bc0 + c1 * c1);
        g.per_ac[0][i] = c0 * per_ac;
        g.per_ac[1][i] = c1 * per_ac;
        g.per_bc[0][i] = bc0 * per_bc;
        g.per_bc[1][i] = c1 * per_bc;
    }
    dot(a, g.u, g.a[0]);
    dot(a, g.v, g.a[1]);
    dot(a, g.n, g.a[2]);
}

Bounds widened(Bounds c) {
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

Bounds bounds_of(const Corners& g, const Index3& origin) {
    const auto& a = g.a;
    Bounds result{};
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
    const auto third = [&](int i) {
        return Vec3(a[0][i], a[1][i], a[2][i]) +
               (Vec3(g.ab[0][i], g.ab[1][i], g.ab[2][i]) + Vec3(g.ac[0][i], g.ac[1][i], g.ac[2][i])) / 3.0f;
    };
    result.point = third(0);
    for (int i = 1; i < eight; ++i)
        if (const Vec3 p = third(i); length2(p - m) < length2(result.point - m))
            result.point = p;
    result.point += Vec3(origin);
    result.centre += 0.5f * (bottom + top) * n + Vec3(origin);
    result.thickness = 0.5f * (top - bottom);
    result.radius = std::sqrt(most_of(across2));
    return widened(result);
}

/// A group of pieces and its bounds.
Bounds make_group(const GroupedPieces& pieces, std::size_t g, TriangleGroup& group) {
    const std::size_t begin = pieces.begin(g), count = pieces.begin(g + 1) - begin;
    const Piece first = pieces.piece(begin);
    group.origin = first.origin;
    group.count = static_cast<std::uint32_t>(count);
    Corners corners;
    for (std::size_t i = 0; i < eight; ++i) {
        if (i < count)
            pieces.expect(begin + i);
        const Piece p = i > 0 && i < count ? pieces.piece(begin + i) : first;
        const Vec3 a = Vec3(p.origin - group.origin) + p.corners[0];
        for (int axis = 0; axis < 3; ++axis) {
            corners.a[axis][i] = a[axis];
            corners.ab[axis][i] = p.corners[1][axis] - p.corners[0][axis];
            corners.ac[axis][i] = p.corners[2][axis] - p.corners[0][axis];
        }
        group.triangle[i] = p.triangle;
    }
    set_frames(corners, group);
    Bounds bounds = bounds_of(corners, group.origin);
    bounds.child = static_cast<std::uint32_t>(g);
    return bounds;
}

/// Of eight nodes.
Bounds bounds_of(std::span<const Bounds> children) {
    Vec3 least(nowhere), most(-nowhere), normal(0.0f);
    for (const Bounds& b : children) {
        least = glm::min(least, b.centre - b.radius);
        most = glm::max(most, b.centre + b.radius);
        normal += b.radius * b.radius * b.axis;
    }
    Bounds result{0.5f * (least + most), unit_or_z(normal), children[0].point, 0.0f, 0.0f, 0};
    float low = nowhere, high = -nowhere;
    for (const Bounds& b : children) {
        const Vec3 way = b.centre - result.centre;
        const float height = glm::dot(way, result.axis);
        const float cosine = std::min(1.0f, std::fabs(glm::dot(b.axis, result.axis)));
        const float sine = std::min(1.0f, glm::length(glm::cross(b.axis, result.axis)));
        const float half = cosine * b.thickness + sine * b.radius;
        if (length2(b.point - result.centre) < length2(result.point - result.centre))
            result.point = b.point;
        low = std::min(low, height - half);
        high = std::max(high, height + half);
        result.radius =
            std::max(result.radius, glm::length(way - height * result.axis) + b.radius + sine * b.thickness);
    }
    result.centre += 0.5f * (low + high) * result.axis;
    result.thickness = 0.5f * (high - low);
    return widened(result);
}

std::size_t in_eights(std::size_t count) {
    return (count + eight - 1) / eight * eight;
}

}

TriangleTree::TriangleTree(const GroupedPieces& pieces) {
    triangles.resize(pieces.count());
    std::size_t total = in_eights(triangles.size());
    for (std::size_t level = total; level > eight; total += level)
        level = in_eights(level / eight);
    nodes.resize(total);
    parallel_for(triangles.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end; ++g)
            nodes[g] = make_group(pieces, g, triangles[g]);
    });
    // The nodes of a level stand at its begin, `count` of them.
    std::size_t first = 0, count = triangles.size();
    const auto fill_up = [&] {
        const Bounds filling{Vec3(nowhere), Vec3(0, 0, 1), Vec3(nowhere), 0.0f, -1.0f, 0};
        std::fill_n(nodes.begin() + static_cast<std::ptrdiff_t>(first + count), in_eights(count) - count,
                    filling);
    };
    fill_up();
    leaves = static_cast<std::uint32_t>(in_eights(count));
    while (count > eight) {
        const std::size_t next = first + in_eights(count), parents = in_eights(count) / eight;
        parallel_for(parents, 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t p = begin; p < end; ++p) {
                const std::size_t child = first + eight * p,
                                  held = std::min<std::size_t>(eight, count - eight * p);
                nodes[next + p] = bounds_of(std::span(nodes).subspan(child, held));
                nodes[next + p].child = static_cast<std::uint32_t>(child);
            }
        });
        first = next;
        count = parents;
        fill_up();
    }
}

}
