#include "alcove/grid/detail/unresolved.h"

#include "alcove/base/detail/closest_point.h"
#include "alcove/base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace alcove {
namespace {

constexpr double thinnest = 0.25, thickest = 2.0; // voxels
// A wall or gap affects many voxels of a brick. A few are just folds of a noisy surface.
constexpr std::size_t fewest_in_brick = 8;

std::uint64_t key_of(const Index3& low) {
    const auto bits = [](int i) { return std::uint64_t{static_cast<std::uint32_t>(i / brick_size)} & 0x1fffff; };
    return bits(low.x) << 42 | bits(low.y) << 21 | bits(low.z);
}

class Finder {
  public:
    Finder(std::span<const NearestOfBrick> nearest, const Surface& surface) : nearest_(nearest), surface_(surface) {
        for (std::size_t b = 0; b < nearest.size(); ++b)
            places_.emplace(key_of(nearest[b].low), b);
    }

    struct Found {
        std::vector<Index3> below_two, below_one;
        std::size_t near_surface = 0, beside = 0;
    };

    /// Compares every voxel of a brick with the next one along each axis.
    Found search(const NearestOfBrick& of) const {
        Found found;
        const std::array<const NearestOfBrick*, 4> bricks{&of, brick_at(of.low + Index3(brick_size, 0, 0)),
                                                          brick_at(of.low + Index3(0, brick_size, 0)),
                                                          brick_at(of.low + Index3(0, 0, brick_size))};
        constexpr std::array<int, 3> steps{brick_size * brick_size, brick_size, 1};
        for (int i = 0; i < brick_volume; ++i) {
            const auto voxel = static_cast<std::size_t>(i);
            const float distance = std::fabs(of.distance[voxel]);
            if (distance > farthest)
                continue;
            found.near_surface += distance < 1.0f;
            const Index3 local(i / steps[0], i / steps[1] % brick_size, i % brick_size);
            double thickness = thickest;
            for (int axis = 0; axis < 3; ++axis) {
                const bool last = local[axis] + 1 == brick_size;
                const NearestOfBrick* other = bricks[last ? static_cast<std::size_t>(axis) + 1 : 0];
                const int j = i + steps[static_cast<std::size_t>(axis)] * (last ? 1 - brick_size : 1);
                const auto next_voxel = static_cast<std::size_t>(j);
                if (!other || std::fabs(other->distance[next_voxel]) > farthest)
                    continue;
                Index3 next = of.low + local;
                ++next[axis];
                thickness = std::min(thickness, thickness_between(of.low + local, of.triangle[voxel], next,
                                                                  other->triangle[next_voxel]));
            }
            if (thickness >= thickest)
                continue;
            found.beside += distance < 1.0f;
            found.below_two.push_back(of.low + local);
            if (thickness < 1.0)
                found.below_one.push_back(of.low + local);
        }
        return found;
    }

  private:
    static constexpr float farthest = 1.5f; // voxels from the triangles of a thin wall or gap

    const NearestOfBrick* brick_at(const Index3& low) const {
        const auto place = places_.find(key_of(low));
        return place == places_.end() ? nullptr : &nearest_[place->second];
    }

    Vec3d normal_of(std::uint32_t triangle) const {
        const auto& [a, b, c] = surface_.triangles[triangle];
        return glm::cross(surface_.positions[b] - surface_.positions[a], surface_.positions[c] - surface_.positions[a]);
    }

    Vec3d closest(std::uint32_t triangle, const Index3& voxel) const {
        const auto& [a, b, c] = surface_.triangles[triangle];
        const Vec3d p(voxel);
        return p - closest_on_triangle(surface_.positions[a], surface_.positions[b], surface_.positions[c], p).offset;
    }

    /// The thickness of the wall or gap between the nearest triangles of two neighbours; infinite if there is none.
    double thickness_between(const Index3& p, std::uint32_t a, const Index3& q, std::uint32_t b) const {
        constexpr double none = std::numeric_limits<double>::infinity();
        constexpr double opposite2 = 0.5; // squared cosine: within 45° of opposite directions
        if (a == b)
            return none;
        const Vec3d na = normal_of(a), nb = normal_of(b);
        const double cosine = glm::dot(na, nb), lengths2 = glm::dot(na, na) * glm::dot(nb, nb);
        if (cosine >= 0.0 || cosine * cosine < opposite2 * lengths2)
            return none;
        const Vec3d axis = glm::normalize(na / glm::length(na) - nb / glm::length(nb));
        const Vec3d between = closest(a, p) - closest(b, q);
        const double thickness = std::fabs(glm::dot(between, axis));
        const bool face_each_other = glm::length(between) < thickness + 1.0;
        return face_each_other && thickness >= thinnest ? thickness : none;
    }

    std::span<const NearestOfBrick> nearest_;
    Surface surface_;
    std::unordered_map<std::uint64_t, std::size_t> places_;
};

}

UnresolvedVoxels find_unresolved(std::span<const NearestOfBrick> nearest, const Surface& surface) {
    const Finder finder(nearest, surface);
    std::vector<Finder::Found> found(nearest.size());
    parallel_for(nearest.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b)
            found[b] = finder.search(nearest[b]);
    });
    UnresolvedVoxels all;
    std::size_t near_surface = 0, beside = 0;
    for (const Finder::Found& one : found) {
        near_surface += one.near_surface;
        if (one.below_two.size() < fewest_in_brick)
            continue;
        all.below_two.insert(all.below_two.end(), one.below_two.begin(), one.below_two.end());
        all.below_one.insert(all.below_one.end(), one.below_one.begin(), one.below_one.end());
        beside += one.beside;
    }
    if (near_surface > 0)
        all.share = static_cast<double>(beside) / static_cast<double>(near_surface);
    return all;
}

}
