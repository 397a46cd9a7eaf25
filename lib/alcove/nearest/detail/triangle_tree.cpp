#include "alcove/nearest/detail/triangle_tree.h"

#include "alcove/base/parallel.h"
#include "alcove/nearest/detail/triangle_leaf.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

constexpr int eight = 8;
static_assert(TriangleLeaf::size == eight && largest_leaf == eight && TriangleTree::children == eight);
// Floats at the far end of the grid are this coarse, relatively; bounds are widened by it.
constexpr float rounding = 0x1p-21f;
constexpr float nowhere = 1e18f; // its square is finite

float length2(const Vec3& v) {
    return glm::dot(v, v);
}

Bounds widened(Bounds c) {
    const float most = std::max({c.centre.x, c.centre.y, c.centre.z, 1.0f});
    c.thickness += rounding * most;
    c.radius += rounding * most;
    return c;
}

/// A group of fragments and its bounds.
Bounds make_group(const FragmentLeaves& fragments, std::size_t g, TriangleLeaf& group) {
    const std::size_t begin = fragments.begin(g), count = fragments.begin(g + 1) - begin;
    const Fragment first = fragments.fragment(begin);
    group.origin = first.origin;
    group.count = static_cast<std::uint32_t>(count);
    Corners corners;
    for (std::size_t i = 0; i < eight; ++i) {
        if (i < count)
            fragments.expect(begin + i);
        const Fragment p = i > 0 && i < count ? fragments.fragment(begin + i) : first;
        const Vec3 a = Vec3(p.origin - group.origin) + p.corners[0];
        for (int axis = 0; axis < 3; ++axis) {
            corners.a[axis][i] = a[axis];
            corners.ab[axis][i] = p.corners[1][axis] - p.corners[0][axis];
            corners.ac[axis][i] = p.corners[2][axis] - p.corners[0][axis];
        }
        group.triangle[i] = p.triangle;
    }
    Bounds bounds = widened(set_frames(corners, group));
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

TriangleTree::TriangleTree(const FragmentLeaves& fragments) {
    triangles.resize(fragments.count());
    std::size_t total = in_eights(triangles.size());
    for (std::size_t level = total; level > eight; total += level)
        level = in_eights(level / eight);
    nodes.resize(total);
    parallel_for(triangles.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end; ++g)
            nodes[g] = make_group(fragments, g, triangles[g]);
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
