#include "alcove/mesh/detail/gaps.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/detail/morton_sort.h"
#include "alcove/mesh/detail/weld.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace alcove {
namespace {

/// The vertices on open edges, and the sides of triangles between these vertices. An edge counts as open if only one
/// triangle uses its two vertex indices.
struct Rim {
    std::vector<std::uint32_t> vertices; ///< in ascending order
    std::vector<Vec3d> positions;
    std::vector<std::array<std::uint32_t, 2>> sides; ///< indices of `vertices`
};

/// One sum per vertex, which is not 0 for a vertex on an open edge. At a vertex inside the surface, the sides that
/// leave the vertex end where the sides that enter it start, so the hashes of those vertices cancel.
std::vector<std::uint64_t> unbalanced_sums(std::size_t vertices, std::span<const Triangle> triangles) {
    const auto hash = [](std::uint64_t v) { // finalizer of MurmurHash3 (Appleby 2011)
        v = (v + 1) * 0x9e3779b97f4a7c15ULL;
        return (v ^ (v >> 33)) * 0xff51afd7ed558ccdULL;
    };
    std::vector<std::uint64_t> sums = huge_vector<std::uint64_t>(vertices);
    for (const auto& [a, b, c] : triangles) {
        const std::uint64_t of_a = hash(a), of_b = hash(b), of_c = hash(c);
        sums[a] += of_b - of_c;
        sums[b] += of_c - of_a;
        sums[c] += of_a - of_b;
    }
    return sums;
}

Rim rim_of(const Mesh& mesh, std::span<const Triangle> triangles) {
    const std::vector<std::uint64_t> sums = unbalanced_sums(mesh.vertex_count(), triangles);
    Rim rim;
    for (std::uint32_t v = 0; v < sums.size(); ++v)
        if (sums[v] != 0) {
            rim.vertices.push_back(v);
            rim.positions.push_back(mesh.positions[v]);
        }
    if (rim.vertices.empty())
        return rim;
    std::vector<std::uint32_t> number(mesh.vertex_count());
    for (std::uint32_t i = 0; i < rim.vertices.size(); ++i)
        number[rim.vertices[i]] = i;
    for (const Triangle& t : triangles)
        for (std::size_t k = 0; k < 3; ++k)
            if (const std::uint32_t a = t[k], b = t[(k + 1) % 3]; sums[a] != 0 && sums[b] != 0)
                rim.sides.push_back({number[a], number[b]});
    return rim;
}

/// The number of edges that only one triangle uses after vertices are joined, plus the number of sides whose two ends
/// are joined.
std::size_t open_edges(const Rim& rim, std::span<const std::uint32_t> joined) {
    const std::uint64_t count = rim.vertices.size();
    HugeVector<Keyed<std::uint64_t>> edges;
    std::size_t open = 0;
    for (const auto& [first, second] : rim.sides) {
        const auto [a, b] = std::minmax(joined[first], joined[second]);
        if (a == b)
            ++open;
        else
            edges.push_back({a * count + b, 0});
    }
    radix_sort(edges, 0, static_cast<int>(std::bit_width(count * count)));
    for (std::size_t at = 0, after = 0; at < edges.size(); at = after) {
        while (after < edges.size() && edges[after].key == edges[at].key)
            ++after;
        open += after - at == 1;
    }
    return open;
}

double largest_distance(const Mesh& mesh, const Rim& rim) {
    std::vector<double> lengths;
    for (const auto& [a, b] : rim.sides)
        lengths.push_back(glm::distance(rim.positions[a], rim.positions[b]));
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    return std::min(1e-4 * frame_of(mesh.box()).diagonal, 0.1 * *middle);
}

/// Rounds up to one significant digit, so that the length is easy to read and type.
double rounded_up(double length) {
    constexpr double rounding = 1.001; // margin for the rounding of the typed length
    const double unit = std::pow(10.0, std::floor(std::log10(length)));
    return std::ceil(rounding * length / unit) * unit;
}

void find_closable(const Mesh& mesh, const Rim& rim, std::size_t open, Gaps& gaps) {
    constexpr double smallest_step = 1e-10, nearly_all = 0.99;
    const double largest = largest_distance(mesh, rim);
    if (!(largest > 0.0))
        return;
    std::vector<std::uint32_t> joined = weld(rim.positions, largest);
    const auto closed = [&](std::span<const std::uint32_t> by) { return open - std::min(open, open_edges(rim, by)); };
    const std::size_t most = closed(joined);
    for (double step = 0.1; most > 0 && step > smallest_step; step *= 0.1) {
        std::vector<std::uint32_t> nearer = weld(rim.positions, step * largest);
        if (static_cast<double>(closed(nearer)) < nearly_all * static_cast<double>(most))
            break;
        joined = std::move(nearer);
    }
    double farthest = 0.0;
    for (std::size_t i = 0; i < joined.size(); ++i)
        farthest = std::max(farthest, glm::distance(rim.positions[i], rim.positions[joined[i]]));
    if (most == 0 || farthest == 0.0)
        return;
    gaps.distance = rounded_up(farthest);
    gaps.closable = closed(weld(rim.positions, gaps.distance));
}

}

Gaps find_gaps(const Mesh& mesh, std::span<const Triangle> triangles) {
    const Rim rim = rim_of(mesh, triangles);
    Gaps gaps;
    if (rim.sides.empty())
        return gaps;
    const std::vector<std::uint32_t> places = weld(rim.positions);
    for (std::size_t i = 0; i < places.size(); ++i)
        if (places[i] != i)
            gaps.repeated.push_back({rim.vertices[i], rim.vertices[places[i]]});
    if (const std::size_t open = open_edges(rim, places); open > 0)
        find_closable(mesh, rim, open, gaps);
    return gaps;
}

std::string Gaps::advice() const {
    if (closable == 0)
        return {};
    return fmt::format(
        "{} would close if vertices within {:.1g} were joined (an exporter may have rounded them "
        "differently); until then there is no inside, and each face has its own normals: add --weld {:.1g}",
        counted(closable, "open edge", "open edges"), distance, distance);
}

}
