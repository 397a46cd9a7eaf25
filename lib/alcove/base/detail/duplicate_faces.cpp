#include "alcove/base/detail/duplicate_faces.h"

#include "alcove/base/detail/morton_sort.h"
#include "alcove/base/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <random>

namespace alcove {
namespace {

/// A hash of a position. Treats -0 as 0.
template <class Position>
std::uint64_t hashed(const Position& p) {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
        hash ^= std::bit_cast<std::uint64_t>(double(p[axis]) + 0.0);
        hash = (hash ^ (hash >> 32)) * 0x9e3779b97f4a7c15ULL;
    }
    return hash ^ (hash >> 29);
}

/// A hash that is the same for triangles with the same corners in any order.
template <class Position>
std::uint64_t hashed(std::span<const Position> positions, const Triangle& t) {
    return hashed(positions[t[0]]) + hashed(positions[t[1]]) + hashed(positions[t[2]]);
}

template <class Position>
bool less(const Position& a, const Position& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/// A triangle in a canonical form. Duplicates have equal forms.
template <class Position>
struct Form {
    std::array<Position, 3> corners; // sorted
    bool turned;                     // the orientation; false if `duplicates` ignores orientation
    std::uint32_t triangle;

    Form(std::span<const Position> positions, const Triangle& t, Duplicates duplicates, std::uint32_t index)
        : corners{positions[t[0]], positions[t[1]], positions[t[2]]}, turned(false), triangle(index) {
        for (const std::size_t i : {0u, 1u, 0u})
            if (less(corners[i + 1], corners[i])) {
                std::swap(corners[i], corners[i + 1]);
                turned = !turned;
            }
        turned = turned && duplicates == Duplicates::of_one_side;
    }
    bool operator==(const Form& other) const { return corners == other.corners && turned == other.turned; }
    bool operator<(const Form& other) const {
        if (corners != other.corners)
            return std::lexicographical_compare(corners.begin(), corners.end(), other.corners.begin(),
                                                other.corners.end(), less<Position>);
        return turned < other.turned;
    }
};

}

template <class Position>
std::vector<Triangle> without_duplicate_faces(std::span<const Position> positions, std::span<const Triangle> triangles,
                                              Duplicates duplicates) {
    HugeVector<Keyed<std::uint64_t>> order(triangles.size());
    parallel_for(triangles.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            order[i] = {hashed(positions, triangles[i]), static_cast<std::uint32_t>(i)};
    });
    radix_sort(order, 0, 64); // stable
    std::vector<char> is_duplicate(triangles.size(), 0);
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        while (end < order.size() && order[end].key == order[begin].key)
            ++end;
        // Usually few triangles share a key, but in a crafted file many could, so sort them.
        std::vector<Form<Position>> group;
        for (std::size_t i = begin; i < end && end - begin > 1; ++i)
            group.emplace_back(positions, triangles[order[i].value], duplicates, order[i].value);
        std::stable_sort(group.begin(), group.end());
        for (std::size_t i = 1; i < group.size(); ++i)
            is_duplicate[group[i].triangle] = group[i] == group[i - 1];
    }
    std::vector<Triangle> kept;
    for (std::size_t i = 0; i < triangles.size(); ++i)
        if (!is_duplicate[i])
            kept.push_back(triangles[i]);
    return kept;
}

template std::vector<Triangle> without_duplicate_faces(std::span<const Vec3>, std::span<const Triangle>, Duplicates);
template std::vector<Triangle> without_duplicate_faces(std::span<const Vec3d>, std::span<const Triangle>, Duplicates);

bool has_duplicates_in_sample(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
    constexpr std::size_t most = 1 << 14;
    const std::size_t count = std::min(triangles.size(), most);
    std::vector<std::uint64_t> keys(count);
    std::minstd_rand random(1); // not at regular steps, because files may list faces in a regular pattern
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t begin = i * triangles.size() / count, end = (i + 1) * triangles.size() / count;
        keys[i] = hashed(positions, triangles[begin + random() % (end - begin)]);
    }
    std::sort(keys.begin(), keys.end());
    return std::adjacent_find(keys.begin(), keys.end()) != keys.end();
}

}
