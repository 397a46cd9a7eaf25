#include "alcove/mesh/detail/corner_tree.h"

#include "alcove/base/detail/morton_sort.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace alcove {

void CornerTree::build(std::span<const glm::dvec2> outline, const std::vector<char>& is_member) {
    align(outline);
    members_.clear();
    for (std::uint32_t corner = 0; corner < outline.size(); ++corner)
        if (is_member[corner])
            members_.push_back({outline[corner], corner});
    sort_members();
    slots_.assign(outline.size(), none);
    for (std::uint32_t slot = 0; slot < members_.size(); ++slot)
        slots_[members_[slot].corner] = slot;

    const std::size_t leaves = (members_.size() + leaf_size - 1) / leaf_size;
    first_leaf_ = std::bit_ceil(leaves);
    bounds_.assign(2 * first_leaf_, {});
    for (std::size_t leaf = 0; leaf < leaves; ++leaf)
        bounds_[first_leaf_ + leaf] = bounds_of_leaf(leaf);
    for (std::size_t node = first_leaf_ - 1; node > 0; --node)
        bounds_[node] = bounds_of_children(node);
}

/// Aligns the boxes with the longest edge, because the long and thin triangles beside it would overlap many oblique
/// boxes.
void CornerTree::align(std::span<const glm::dvec2> outline) {
    glm::dvec2 longest(0.0);
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec2 edge = outline[i] - outline[i == 0 ? outline.size() - 1 : i - 1];
        if (glm::dot(edge, edge) > glm::dot(longest, longest))
            longest = edge;
    }
    axis_ = longest == glm::dvec2(0.0) ? glm::dvec2(1.0, 0.0) : glm::normalize(longest);
}

glm::dvec2 CornerTree::aligned(const glm::dvec2& p) const {
    return {glm::dot(axis_, p), axis_.x * p.y - axis_.y * p.x};
}

void CornerTree::sort_members() {
    if (members_.size() <= leaf_size)
        return;
    Bounds all;
    for (const Member& member : members_) {
        all.min = glm::min(all.min, aligned(member.point));
        all.max = glm::max(all.max, aligned(member.point));
    }
    constexpr double cells = (1 << morton_bits) - 1;
    const double extent = std::max(all.max.x - all.min.x, all.max.y - all.min.y);
    const double scale = extent > 0.0 ? cells / extent : 0.0;
    std::vector<std::pair<std::uint64_t, Member>> coded;
    coded.reserve(members_.size());
    for (const Member& member : members_)
        coded.emplace_back(morton_code({scale * (aligned(member.point) - all.min), 0.0}), member);
    std::sort(coded.begin(), coded.end(), [](const auto& a, const auto& b) {
        return a.first != b.first ? a.first < b.first : a.second.corner < b.second.corner;
    });
    std::transform(coded.begin(), coded.end(), members_.begin(), [](const auto& pair) { return pair.second; });
}

void CornerTree::remove(std::size_t corner) {
    const std::size_t leaf = slots_[corner] / leaf_size;
    members_[slots_[corner]].corner = none;
    slots_[corner] = none;
    std::size_t node = first_leaf_ + leaf;
    bounds_[node] = bounds_of_leaf(leaf);
    for (node /= 2; node > 0; node /= 2) {
        const Bounds bounds = bounds_of_children(node);
        if (bounds == bounds_[node])
            break;
        bounds_[node] = bounds;
    }
}

CornerTree::Bounds CornerTree::bounds_of_leaf(std::size_t leaf) const {
    Bounds bounds;
    const std::size_t first = leaf * leaf_size;
    for (std::size_t i = first; i < std::min(first + leaf_size, members_.size()); ++i)
        if (members_[i].corner != none) {
            bounds.min = glm::min(bounds.min, aligned(members_[i].point));
            bounds.max = glm::max(bounds.max, aligned(members_[i].point));
        }
    return bounds;
}

CornerTree::Bounds CornerTree::bounds_of_children(std::size_t node) const {
    const Bounds &left = bounds_[2 * node], &right = bounds_[2 * node + 1];
    return {glm::min(left.min, right.min), glm::max(left.max, right.max)};
}

bool CornerTree::overlaps(const Bounds& bounds, const std::array<glm::dvec2, 3>& triangle) {
    constexpr double rounding = 1e-14; // errors of aligned coordinates
    const auto& [a, b, c] = triangle;
    const glm::dvec2 low = glm::min(glm::min(a, b), c) - rounding, high = glm::max(glm::max(a, b), c) + rounding;
    if (low.x > bounds.max.x || low.y > bounds.max.y || high.x < bounds.min.x || high.y < bounds.min.y)
        return false;
    // Whether the box extends to the left of a side of the triangle; the corner of the box farthest to the left
    // decides.
    const auto reaches = [&bounds](const glm::dvec2& from, const glm::dvec2& to) {
        const glm::dvec2 corner{to.y >= from.y ? bounds.min.x : bounds.max.x,
                                to.x >= from.x ? bounds.max.y : bounds.min.y};
        return turn(from, to, corner) >= -rounding * (std::abs(to.x - from.x) + std::abs(to.y - from.y) + rounding);
    };
    return reaches(a, b) && reaches(b, c) && reaches(c, a);
}

}
