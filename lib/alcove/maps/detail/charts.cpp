#include "alcove/maps/detail/charts.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace alcove {
namespace {

struct Edge {
    std::uint32_t low, high; ///< vertices
    std::uint32_t triangle;
    std::uint8_t at_low, at_high; ///< the triangle's corners there

    auto vertices() const { return std::pair(low, high); }
};

std::uint32_t root_of(std::vector<std::uint32_t>& parents, std::uint32_t item) {
    while (parents[item] != item)
        item = parents[item] = parents[parents[item]];
    return item;
}

}

std::vector<std::uint32_t> charts_of(std::span<const Triangle> vertices, std::span<const UvTriangle> uvs,
                                     std::span<const std::array<Vec3, 3>> normals) {
    std::vector<Edge> edges;
    edges.reserve(3 * vertices.size());
    for (std::uint32_t t = 0; t < vertices.size(); ++t)
        for (std::uint8_t k = 0; k < 3; ++k) {
            const auto next = static_cast<std::uint8_t>((k + 1) % 3);
            const std::uint32_t a = vertices[t][k], b = vertices[t][next];
            edges.push_back(a < b ? Edge{a, b, t, k, next} : Edge{b, a, t, next, k});
        }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return a.vertices() != b.vertices() ? a.vertices() < b.vertices() : a.triangle < b.triangle;
    });
    const auto are_joined = [&](const Edge& a, const Edge& b) {
        constexpr float least_cosine = 0.999f;
        const auto agree = [&](std::uint8_t at_a, std::uint8_t at_b) {
            return uvs[a.triangle][at_a] == uvs[b.triangle][at_b] &&
                   glm::dot(normals[a.triangle][at_a], normals[b.triangle][at_b]) >= least_cosine;
        };
        return agree(a.at_low, b.at_low) && agree(a.at_high, b.at_high);
    };
    std::vector<std::uint32_t> parents(vertices.size());
    std::iota(parents.begin(), parents.end(), 0u);
    for (std::size_t i = 1; i < edges.size(); ++i)
        if (edges[i].vertices() == edges[i - 1].vertices() && are_joined(edges[i - 1], edges[i])) {
            const std::uint32_t a = root_of(parents, edges[i - 1].triangle), b = root_of(parents, edges[i].triangle);
            parents[std::max(a, b)] = std::min(a, b);
        }
    for (std::uint32_t t = 0; t < parents.size(); ++t)
        parents[t] = root_of(parents, t);
    return parents;
}

}
