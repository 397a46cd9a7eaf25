#include "alcove/nearest/detail/fragments.h"

#include "alcove/base/detail/morton_sort.h"
#include "alcove/base/parallel.h"
#include "alcove/mesh/mesh.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

constexpr std::size_t grain = 4096;          // triangles
constexpr double most_cells = (1 << 10) - 1; // along an axis: a key has 3 × 10 bits

double length2(const Vec3d& v) {
    return glm::dot(v, v);
}

double longest2(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    return std::max({length2(b - a), length2(c - b), length2(a - c)});
}

/// Triangles up to this height above their longest side are sliced across it, others are halved.
constexpr double highest_slice = 0.7 * longest_fragment;

/// Calls `visit(corners)` for each fragment of a triangle whose longest side is bc, `height` below a. Halving would
/// cut a needle into a number of fragments that grows with its length to the power of 1.6.
template <class Visit>
void slice(const Vec3d& a, const Vec3d& b, const Vec3d& c, double height, Visit&& visit) {
    const double side2 = length2(c - b), foot = glm::dot(a - b, c - b) / side2;
    const auto above = [&](double t) {
        return t < foot ? b + t / foot * (a - b) : a + (t - foot) / (1.0 - foot) * (c - a);
    };
    const auto count =
        static_cast<int>(std::ceil(std::sqrt(side2 / (longest_fragment * longest_fragment - height * height))));
    Vec3d low = b, high = b;
    const auto add = [&](const Vec3d& next_low, const Vec3d& next_high) {
        visit(low, next_low, next_high);
        visit(low, next_high, high);
        low = next_low, high = next_high;
    };
    bool at_foot = foot <= 0.0 || foot >= 1.0;
    for (int i = 1; i <= count; ++i) {
        const double t = static_cast<double>(i) / count;
        if (!at_foot && t >= foot) {
            add(b + foot * (c - b), a);
            at_foot = true;
        }
        if (i == count || t != foot)
            add(i < count ? b + t * (c - b) : c, i < count ? above(t) : c);
    }
}

/// Calls `visit(corners)` for each fragment of a triangle.
template <class Visit>
void cut(const Vec3d& a, const Vec3d& b, const Vec3d& c, Visit&& visit) {
    const double ab = length2(b - a), bc = length2(c - b), ca = length2(a - c);
    if (bc < ab || bc < ca)
        return ab > ca ? cut(c, a, b, visit) : cut(b, c, a, visit);
    if (bc <= longest_fragment * longest_fragment)
        return visit(a, b, c);
    const double height = glm::length(glm::cross(b - a, c - a)) / std::sqrt(bc);
    if (height <= highest_slice)
        return slice(a, b, c, height, visit);
    const Vec3d middle = 0.5 * (b + c);
    cut(a, b, middle, visit);
    cut(a, middle, c, visit);
}

bool has_area(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    return length2(glm::cross(b - a, c - a)) > 0.0;
}

Fragment fragment_of(const Vec3d& a, const Vec3d& b, const Vec3d& c, std::size_t triangle) {
    const Index3 voxel(a); // rounds down, as no coordinate is negative
    const Vec3d origin(voxel);
    return {voxel, {Vec3(a - origin), Vec3(b - origin), Vec3(c - origin)}, static_cast<std::uint32_t>(triangle)};
}

}

FragmentLeaves::FragmentLeaves(std::span<const Vec3d> positions, std::span<const Triangle> triangles)
    : positions_(positions), triangles_(triangles) {
    double extent = 1.0;
    for (const Vec3d& p : positions)
        if (is_finite(p))
            extent = std::max({extent, p.x, p.y, p.z});
    const double scale = std::min(most_cells_per_voxel, most_cells / extent);

    // Most triangles are one fragment, computed on request; only the fragments of cut triangles are stored.
    struct Cut {
        std::vector<FragmentKey> whole; // by triangle
        std::vector<FragmentKey> parts; // by index into fragments
        std::vector<Fragment> fragments;
    };
    std::vector<Cut> blocks((triangles.size() + grain - 1) / grain);
    parallel_for(triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
        Cut& block = blocks[begin / grain];
        block.whole.reserve(end - begin);
        for (std::size_t t = begin; t < end; ++t) {
            const Vec3d &a = positions[triangles[t][0]], &b = positions[triangles[t][1]],
                        &c = positions[triangles[t][2]];
            const auto key = [&](const Vec3d& p, const Vec3d& q, const Vec3d& r) {
                return static_cast<std::uint32_t>(morton_code(scale / 3.0 * (p + q + r)));
            };
            if (!has_area(a, b, c))
                continue;
            if (longest2(a, b, c) <= longest_fragment * longest_fragment) {
                block.whole.push_back({key(a, b, c), static_cast<std::uint32_t>(t)});
                continue;
            }
            cut(a, b, c, [&](const Vec3d& p, const Vec3d& q, const Vec3d& r) {
                if (!has_area(p, q, r))
                    return;
                block.parts.push_back({key(p, q, r), static_cast<std::uint32_t>(block.fragments.size())});
                block.fragments.push_back(fragment_of(p, q, r, t));
            });
        }
    });
    std::size_t count = 0;
    for (const Cut& block : blocks)
        count += block.whole.size() + block.parts.size();
    order_.reserve(count);
    for (Cut& block : blocks) {
        order_.insert(order_.end(), block.whole.begin(), block.whole.end());
        for (const FragmentKey& part : block.parts)
            order_.push_back({part.key, static_cast<std::uint32_t>(triangles.size() + parts_.size() + part.value)});
        parts_.insert(parts_.end(), block.fragments.begin(), block.fragments.end());
        block = {};
    }
    radix_sort(order_, 0, 3 * (std::ilogb(scale * extent) + 1));
    begin_ = group_fragments(order_, scale);
}

void FragmentLeaves::prefetch(std::size_t i) const {
    constexpr std::size_t ahead = 32; // prefetch distance of a triangle; half as far for its corners
    if (i + ahead >= order_.size())
        return;
    if (const std::uint32_t later = order_[i + ahead].value; later < triangles_.size())
        __builtin_prefetch(&triangles_[later]);
    if (const std::uint32_t next = order_[i + ahead / 2].value; next < triangles_.size())
        for (const std::uint32_t corner : triangles_[next])
            __builtin_prefetch(&positions_[corner]);
}

Fragment FragmentLeaves::fragment(std::size_t i) const {
    const std::uint32_t value = order_[i].value;
    if (value >= triangles_.size())
        return parts_[value - triangles_.size()];
    const Triangle& t = triangles_[value];
    return fragment_of(positions_[t[0]], positions_[t[1]], positions_[t[2]], value);
}

}
