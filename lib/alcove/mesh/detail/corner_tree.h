/// Finds the corners of an outline that lie in a triangle, with a tree of boxes.
#pragma once

#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace alcove {

/// Twice the area of the triangle a, b, c; positive if the path a, b, c turns left.
inline double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
}

/// Whether the path a, b, c turns left by more than the rounding errors of coordinates of about 1.
inline bool turns_left(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    constexpr double rounding = 1e-14;
    const double lengths = std::abs(b.x - a.x) + std::abs(b.y - a.y) + std::abs(c.x - b.x) + std::abs(c.y - b.y);
    return turn(a, b, c) > rounding * lengths;
}

/// A tree of the corners of an outline. Reuses its buffers.
class CornerTree {
  public:
    /// Builds the tree of the corners for which `is_member` is true.
    void build(std::span<const glm::dvec2> outline, const std::vector<char>& is_member);
    void remove(std::size_t corner);
    bool has(std::size_t corner) const { return slots_[corner] != none; }

    /// Whether `counts` returns true for the index of any corner in or on the triangle, which must be counterclockwise.
    template <class Predicate>
    bool any_in(const std::array<glm::dvec2, 3>& triangle, Predicate&& counts) const;

  private:
    static constexpr std::size_t leaf_size = 8;
    static constexpr std::uint32_t none = 0xffffffffu;
    static constexpr double infinity = std::numeric_limits<double>::infinity();

    struct Member {
        glm::dvec2 point;
        std::uint32_t corner; ///< `none` once it is removed
    };
    /// A box in aligned coordinates; empty if no member is left in it.
    struct Bounds {
        glm::dvec2 min{infinity}, max{-infinity};
        bool operator==(const Bounds&) const = default;
    };

    void align(std::span<const glm::dvec2> outline);
    glm::dvec2 aligned(const glm::dvec2& p) const;
    void sort_members();
    Bounds bounds_of_leaf(std::size_t leaf) const;
    Bounds bounds_of_children(std::size_t node) const;
    static bool overlaps(const Bounds& bounds, const std::array<glm::dvec2, 3>& triangle);

    glm::dvec2 axis_{1.0, 0.0};        ///< direction of a side of the boxes
    std::vector<Member> members_;      ///< ordered so that nearby members are close in the array
    std::vector<std::uint32_t> slots_; ///< for each corner, its index in `members_`, or `none`
    std::size_t first_leaf_ = 1;       ///< a power of two
    std::vector<Bounds> bounds_;       ///< of node 1, the root; the children of node i are 2 i and 2 i + 1
};

template <class Predicate>
bool CornerTree::any_in(const std::array<glm::dvec2, 3>& triangle, Predicate&& counts) const {
    const auto& [a, b, c] = triangle;
    const std::array<glm::dvec2, 3> seen{aligned(a), aligned(b), aligned(c)};
    std::array<std::size_t, 64> nodes; // still to visit: at most one per level, plus one
    std::size_t count = 0;
    nodes[count++] = 1;
    while (count > 0) {
        const std::size_t node = nodes[--count];
        if (!overlaps(bounds_[node], seen))
            continue;
        if (node < first_leaf_) {
            nodes[count++] = 2 * node + 1;
            nodes[count++] = 2 * node;
            continue;
        }
        const std::size_t first = (node - first_leaf_) * leaf_size;
        for (std::size_t i = first; i < std::min(first + leaf_size, members_.size()); ++i) {
            const auto& [p, corner] = members_[i];
            if (corner != none && !turns_left(b, a, p) && !turns_left(c, b, p) && !turns_left(a, c, p) &&
                counts(corner))
                return true;
        }
    }
    return false;
}

}
