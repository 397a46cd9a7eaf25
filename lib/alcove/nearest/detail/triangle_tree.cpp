#include "alcove/nearest/detail/triangle_tree.h"

#include "alcove/base/parallel.h"
#include "alcove/nearest/detail/triangle_leaf.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

constexpr int eight = 8;
static_assert(TriangleLeaf::size == eight && largest_leaf == eight && TriangleTree::children == eight);
// Relative rounding error of floats; bounds are widened by it.
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

/// Fills a leaf with its fragments and returns its bounds.
Bounds fill_leaf(const FragmentLeaves& fragments, std::size_t g, TriangleLeaf& leaf) {
    const std::size_t begin = fragments.begin(g), count = fragments.begin(g + 1) - begin;
    const Fragment first = fragments.fragment(begin);
    leaf.origin = first.origin;
    leaf.count = static_cast<std::uint32_t>(count);
    Corners corners;
    for (std::size_t i = 0; i < eight; ++i) {
        if (i < count)
            fragments.prefetch(begin + i);
        const Fragment p = i > 0 && i < count ? fragments.fragment(begin + i) : first;
        const Vec3 a = Vec3(p.origin - leaf.origin) + p.corners[0];
        for (int axis = 0; axis < 3; ++axis) {
            corners.a[axis][i] = a[axis];
            corners.ab[axis][i] = p.corners[1][axis] - p.corners[0][axis];
            corners.ac[axis][i] = p.corners[2][axis] - p.corners[0][axis];
        }
        leaf.triangle[i] = p.triangle;
    }
    Bounds bounds = widened(set_frames(corners, leaf));
    bounds.child = static_cast<std::uint32_t>(g);
    return bounds;
}

/// The bounds of up to eight nodes.
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
        const Vec3 offset = b.centre - result.centre;
        const float height = glm::dot(offset, result.axis);
        const float cosine = std::min(1.0f, std::fabs(glm::dot(b.axis, result.axis)));
        const float sine = std::min(1.0f, glm::length(glm::cross(b.axis, result.axis)));
        const float half = cosine * b.thickness + sine * b.radius;
        if (length2(b.point - result.centre) < length2(result.point - result.centre))
            result.point = b.point;
        low = std::min(low, height - half);
        high = std::max(high, height + half);
        result.radius =
            std::max(result.radius, glm::length(offset - height * result.axis) + b.radius + sine * b.thickness);
    }
    result.centre += 0.5f * (low + high) * result.axis;
    result.thickness = 0.5f * (high - low);
    return widened(result);
}

std::size_t round_up_to_eight(std::size_t count) {
    return (count + eight - 1) / eight * eight;
}

}

TriangleTree::TriangleTree(const FragmentLeaves& fragments) {
    triangles.resize(fragments.count());
    std::size_t total = round_up_to_eight(triangles.size());
    for (std::size_t level = total; level > eight; total += level)
        level = round_up_to_eight(level / eight);
    nodes.resize(total);
    parallel_for(triangles.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end; ++g)
            nodes[g] = fill_leaf(fragments, g, triangles[g]);
    });
    // The current level has `count` nodes, beginning at `first`, followed by padding.
    std::size_t first = 0, count = triangles.size();
    const auto add_padding = [&] {
        const Bounds padding{Vec3(nowhere), Vec3(0, 0, 1), Vec3(nowhere), 0.0f, -1.0f, 0};
        std::fill_n(nodes.begin() + static_cast<std::ptrdiff_t>(first + count), round_up_to_eight(count) - count,
                    padding);
    };
    add_padding();
    leaves = static_cast<std::uint32_t>(round_up_to_eight(count));
    while (count > eight) {
        const std::size_t next = first + round_up_to_eight(count), parents = round_up_to_eight(count) / eight;
        parallel_for(parents, 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t p = begin; p < end; ++p) {
                const std::size_t child = first + eight * p, used = std::min<std::size_t>(eight, count - eight * p);
                nodes[next + p] = bounds_of(std::span(nodes).subspan(child, used));
                nodes[next + p].child = static_cast<std::uint32_t>(child);
            }
        });
        first = next;
        count = parents;
        add_padding();
    }
}

}
