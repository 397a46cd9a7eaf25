#include "alcove/grid/detail/duplicate_faces.h"

#include "alcove/base/detail/morton_sort.h"
#include "alcove/base/parallel.h"

#include <algorithm>
#include <array>
#include <bit>

namespace alcove {
namespace {

/// A hash of a position that treats -0 as 0.
std::uint64_t hashed(const Vec3d& p) {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
        hash ^= std::bit_cast<std::uint64_t>(p[axis] + 0.0);
        hash = (hash ^ (hash >> 32)) * 0x9e3779b97f4a7c15ULL;
    }
    return hash ^ (hash >> 29);
}

bool less(const Vec3d& a, const Vec3d& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/// The corners in an order independent of the first corner and of the orientation.
std::array<Vec3d, 3> sorted_corners(std::span<const Vec3d> positions, const Triangle& t) {
    std::array<Vec3d, 3> corners{positions[t[0]], positions[t[1]], positions[t[2]]};
    std::sort(corners.begin(), corners.end(), less);
    return corners;
}

}

std::vector<Triangle> without_duplicate_faces(std::span<const Vec3d> positions, std::span<const Triangle> triangles) {
    HugeVector<Keyed<std::uint64_t>> order(triangles.size());
    parallel_for(triangles.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Triangle& t = triangles[i];
            order[i] = {hashed(positions[t[0]]) + hashed(positions[t[1]]) + hashed(positions[t[2]]),
                        static_cast<std::uint32_t>(i)};
        }
    });
    radix_sort(order, 0, 64); // stable
    std::vector<char> is_duplicate(triangles.size(), 0);
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        while (end < order.size() && order[end].key == order[begin].key)
            ++end;
        // Usually few triangles share a key, but a crafted file could make it many.
        std::vector<std::pair<std::array<Vec3d, 3>, std::uint32_t>> group;
        for (std::size_t i = begin; i < end && end - begin > 1; ++i)
            group.emplace_back(sorted_corners(positions, triangles[order[i].value]), order[i].value);
        std::stable_sort(group.begin(), group.end(), [](const auto& a, const auto& b) {
            return std::lexicographical_compare(a.first.begin(), a.first.end(), b.first.begin(), b.first.end(), less);
        });
        for (std::size_t i = 1; i < group.size(); ++i)
            is_duplicate[group[i].second] = group[i].first == group[i - 1].first;
    }
    std::vector<Triangle> kept;
    for (std::size_t i = 0; i < triangles.size(); ++i)
        if (!is_duplicate[i])
            kept.push_back(triangles[i]);
    return kept;
}

}
