#include "alcove/occlusion/detail/triangle_pairs.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

/// Adds the triangle to the pair if the pair has only one triangle so far and the two share an edge.
bool join(TrianglePair& pair, const Triangle& triangle) {
    if (pair[3] != pair[2])
        return false;
    const auto shared = [&](std::uint32_t corner) {
        return std::find(triangle.begin(), triangle.end(), corner) != triangle.end();
    };
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t apex = pair[k], a = pair[(k + 1) % 3], b = pair[(k + 2) % 3];
        if (!shared(apex) && shared(a) && shared(b)) {
            const std::uint32_t opposite = triangle[0] ^ triangle[1] ^ triangle[2] ^ a ^ b;
            pair = {apex, a, opposite, b};
            return true;
        }
    }
    return false;
}

}

bool can_be_hit(std::span<const Vec3> positions, const Triangle& t) {
    const auto finite = [&](std::uint32_t corner) {
        const Vec3& p = positions[corner];
        return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    };
    return t[0] != t[1] && t[1] != t[2] && t[2] != t[0] && std::all_of(t.begin(), t.end(), finite);
}

std::vector<TrianglePair> pair_triangles(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
    constexpr std::uint32_t none = ~0u;
    std::vector<TrianglePair> pairs;
    pairs.reserve(triangles.size());
    std::vector<std::uint32_t> latest(positions.size(), none); // latest pair at each position
    for (const Triangle& t : triangles) {
        if (!can_be_hit(positions, t) || std::any_of(t.begin(), t.end(), [&](std::uint32_t corner) {
                return latest[corner] != none && join(pairs[latest[corner]], t);
            }))
            continue;
        for (const std::uint32_t corner : t)
            latest[corner] = static_cast<std::uint32_t>(pairs.size());
        pairs.push_back({t[0], t[1], t[2], t[2]});
    }
    return pairs;
}

}
