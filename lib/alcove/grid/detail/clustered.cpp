#include "alcove/grid/detail/clustered.h"

#include "alcove/base/parallel.h"
#include "alcove/mesh/detail/edge_table.h"
#include "alcove/mesh/detail/weld.h"

#include <algorithm>
#include <atomic>
#include <vector>

namespace alcove {
namespace {

constexpr std::size_t grain = 1 << 14;

/// The cube of each vertex, as a packed index.
HugeVector<std::uint64_t> cells_of(std::span<const Vec3d> positions, double cell) {
    HugeVector<std::uint64_t> cells(positions.size());
    parallel_for(positions.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const Vec3d at = is_finite(positions[v]) ? positions[v] / cell : Vec3d(0.0);
            cells[v] = static_cast<std::uint64_t>(at.x) << 42 | static_cast<std::uint64_t>(at.y) << 21 |
                       static_cast<std::uint64_t>(at.z);
        }
    });
    return cells;
}

/// Calls `visit(triangle, out)` for each triangle, in parallel blocks; concatenates the outputs in order.
template <class Visit>
void collect(std::span<const Triangle> triangles, HugeVector<Triangle>& all, const Visit& visit) {
    std::vector<std::vector<Triangle>> blocks((triangles.size() + grain - 1) / grain);
    parallel_for(triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (const Triangle& t : triangles.subspan(begin, end - begin))
            visit(t, blocks[begin / grain]);
    });
    std::size_t count = 0;
    for (const std::vector<Triangle>& block : blocks)
        count += block.size();
    all.reserve(count);
    for (const std::vector<Triangle>& block : blocks)
        all.insert(all.end(), block.begin(), block.end());
}

/// The sets of vertices that share a cube and are connected within it.
DisjointSets clusters_of(const Surface& surface, bool is_balanced, double cell) {
    const HugeVector<std::uint64_t> cells = cells_of(surface.positions, cell);
    DisjointSets clusters(cells.size());
    if (!is_balanced) { // otherwise seams would open
        const std::vector<std::uint32_t> first = weld(surface.positions);
        for (std::uint32_t v = 0; v < first.size(); ++v)
            clusters.join(v, first[v]);
    }
    // Edges of a balanced surface have both directions: only one is visited. The bitwise operators give a single
    // branch, which is rarely mispredicted.
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
        if (((a < b) | !is_balanced) & (cells[a] == cells[b]) & !clusters.surely_joined(a, b))
            clusters.join(a, b);
    };
    for (const auto& [a, b, c] : surface.triangles) {
        join(a, b);
        join(b, c);
        join(c, a);
    }
    return clusters;
}

}

ClusteredSurface::ClusteredSurface(const Surface& surface, bool is_balanced, double cell) {
    const std::vector<std::uint32_t> cluster_of = merge(surface, is_balanced, cell);
    const auto renamed = [&](const Triangle& t) {
        return Triangle{cluster_of[t[0]], cluster_of[t[1]], cluster_of[t[2]]};
    };
    const auto is_triangle = [](const Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; };
    const double far2 = 12.0 * cell * cell; // twice the diagonal of a cube, squared
    const auto far = [&](std::uint32_t a, std::uint32_t b) {
        const Vec3d offset = positions_[a] - positions_[b];
        return a != b && glm::dot(offset, offset) > far2;
    };
    const auto is_strut = [&](const Triangle& t) { return far(t[0], t[1]) || far(t[1], t[2]); }; // if collapsed
    std::atomic<bool> any_strut{false};
    collect(surface.triangles, triangles_, [&](const Triangle& t, std::vector<Triangle>& kept) {
        const Triangle now = renamed(t);
        if (is_triangle(now))
            kept.push_back(now);
        else if (is_strut(now))
            any_strut = true;
    });

    // Find the collapsed triangles that no kept triangle covers; this needs all kept triangles.
    std::vector<std::uint8_t> unused(positions_.size(), 1); // new vertices without a kept triangle
    for (const Triangle& t : triangles_)
        for (const std::uint32_t v : t)
            unused[v] = 0;
    if (!any_strut && std::find(unused.begin(), unused.end(), 1) == unused.end())
        return;
    HugeVector<Triangle> uncovered;
    collect(surface.triangles, uncovered, [&](const Triangle& t, std::vector<Triangle>& kept) {
        const Triangle now = renamed(t);
        const auto& [a, b, c] = now;
        if (!is_triangle(now) && ((unused[a] | unused[b] | unused[c]) != 0 || is_strut(now)))
            kept.push_back(t);
    });
    positions_.reserve(positions_.size() + 3 * uncovered.size());
    triangles_.reserve(triangles_.size() + uncovered.size());
    for (const Triangle& t : uncovered) {
        const auto first = static_cast<std::uint32_t>(positions_.size());
        for (const std::uint32_t v : t)
            positions_.push_back(surface.positions[v]);
        triangles_.push_back({first, first + 1, first + 2});
    }
}

/// Returns the index of each vertex's cluster.
std::vector<std::uint32_t> ClusteredSurface::merge(const Surface& surface, bool is_balanced, double cell) {
    DisjointSets clusters = clusters_of(surface, is_balanced, cell);
    std::vector<std::uint32_t> cluster_of = huge_vector<std::uint32_t>(surface.positions.size());
    std::vector<double> counts;
    positions_.reserve(cluster_of.size()); // untouched capacity costs nothing
    for (std::uint32_t v = 0; v < cluster_of.size(); ++v) {
        const std::uint32_t first = clusters.find(v);
        if (first == v) {
            cluster_of[v] = static_cast<std::uint32_t>(counts.size());
            positions_.push_back(surface.positions[v]);
            counts.push_back(1.0);
        } else {
            cluster_of[v] = cluster_of[first];
            positions_[cluster_of[v]] += surface.positions[v];
            counts[cluster_of[v]] += 1.0;
        }
    }
    for (std::size_t v = 0; v < counts.size(); ++v)
        positions_[v] /= counts[v];
    return cluster_of;
}

}
