#include "alcove/maps/detail/charts.h"

#include "alcove/base/detail/morton_sort.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <tuple>
#include <utility>

namespace alcove {
namespace {

/// The side of a triangle that starts at a corner. Its ends are ordered by vertex index.
struct Edge {
    std::uint32_t triangle;
    std::size_t at_low, at_high; ///< the corners of the triangle at the smaller and the larger index

    Edge(std::span<const Triangle> vertices, std::uint32_t corner) : triangle(corner / 3) {
        const std::size_t here = corner % 3, next = (here + 1) % 3;
        std::tie(at_low, at_high) =
            vertices[triangle][here] < vertices[triangle][next] ? std::pair(here, next) : std::pair(next, here);
    }
};

/// All corners, sorted by the vertices at the ends of the sides that start there.
HugeVector<Keyed<std::uint64_t>> sides_by_vertices(std::span<const Triangle> vertices) {
    std::uint32_t last = 0;
    for (const Triangle& t : vertices)
        last = std::max({last, t[0], t[1], t[2]});
    const int bits = std::bit_width(last);
    HugeVector<Keyed<std::uint64_t>> sides(3 * vertices.size());
    for (std::uint32_t corner = 0; corner < sides.size(); ++corner) {
        const Edge edge(vertices, corner);
        const Triangle& t = vertices[edge.triangle];
        sides[corner] = {std::uint64_t{t[edge.at_low]} << bits | t[edge.at_high], corner};
    }
    radix_sort(sides, 0, 2 * bits);
    return sides;
}

std::uint32_t root_of(std::vector<std::uint32_t>& parents, std::uint32_t item) {
    while (parents[item] != item)
        item = parents[item] = parents[parents[item]];
    return item;
}

}

std::vector<std::uint32_t> charts_of(std::span<const Triangle> vertices, std::span<const UvTriangle> uvs,
                                     std::span<const std::array<Vec3, 3>> normals) {
    const auto are_joined = [&](const Edge& a, const Edge& b) {
        constexpr float least_cosine = 0.999f;
        const auto agree = [&](std::size_t at_a, std::size_t at_b) {
            return uvs[a.triangle][at_a] == uvs[b.triangle][at_b] &&
                   glm::dot(normals[a.triangle][at_a], normals[b.triangle][at_b]) >= least_cosine;
        };
        return agree(a.at_low, b.at_low) && agree(a.at_high, b.at_high);
    };
    std::vector<std::uint32_t> parents(vertices.size());
    std::iota(parents.begin(), parents.end(), 0u);
    const HugeVector<Keyed<std::uint64_t>> sides = sides_by_vertices(vertices);
    for (std::size_t i = 1; i < sides.size(); ++i) {
        if (sides[i].key != sides[i - 1].key)
            continue;
        const Edge before(vertices, sides[i - 1].value), edge(vertices, sides[i].value);
        if (are_joined(before, edge)) {
            const std::uint32_t a = root_of(parents, before.triangle), b = root_of(parents, edge.triangle);
            parents[std::max(a, b)] = std::min(a, b);
        }
    }
    for (std::uint32_t t = 0; t < parents.size(); ++t)
        parents[t] = root_of(parents, t);
    return parents;
}

}
