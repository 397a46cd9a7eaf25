#include "alcove/grid/detail/clustered.h"

#include "alcove/base/parallel.h"
#include "alcove/mesh/detail/weld.h"

#include <algorithm>
#include <atomic>
#include <vector>

namespace alcove {
namespace {

constexpr std::size_t grain = 1 << 14;

using Cells = HugeVector<std::uint64_t>;

/// The cube of each vertex, as a packed index.
Cells cells_of(std::span<const Vec3d> positions, double cell) {
    Cells cells(positions.size());
    const double per_cell = 1.0 / cell;
    parallel_for(positions.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const Vec3d at = is_finite(positions[v]) ? per_cell * positions[v] : Vec3d(0.0);
            const auto index = [](double x) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(x)); };
            cells[v] = index(at.x) << 42 | index(at.y) << 21 | index(at.z);
        }
    });
    return cells;
}

/// Whether two cubes touch, so that no two points in them are more than 2√3 cells apart. The indices of such cubes
/// differ by −1, 0 or 1 along each axis. Far cubes might seem to touch if they are 2^21 − 1 cells apart.
bool touch(std::uint64_t a, std::uint64_t b) {
    constexpr std::uint64_t one_each = std::uint64_t{1} << 42 | std::uint64_t{1} << 21 | 1;
    const std::uint64_t difference = a - b + one_each;
    return ((difference & ~(3 * one_each)) | (difference & difference >> 1 & one_each)) == 0;
}

/// 1 if x is 0, and 0 if it is less than 2^63. Compilers often turn several comparisons into as many branches, which
/// are mispredicted.
std::uint64_t one_if_zero(std::uint64_t x) {
    return (x - 1) >> 63;
}

/// Calls `visit(i, out)` for each number below `count_of_all`, in parallel blocks; concatenates the outputs in order.
template <class Visit>
void collect(std::size_t count_of_all, HugeVector<Triangle>& all, const Visit& visit) {
    std::vector<std::vector<Triangle>> blocks((count_of_all + grain - 1) / grain);
    parallel_for(count_of_all, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            visit(i, blocks[begin / grain]);
    });
    std::size_t count = 0;
    for (const std::vector<Triangle>& block : blocks)
        count += block.size();
    all.reserve(count);
    for (const std::vector<Triangle>& block : blocks)
        all.insert(all.end(), block.begin(), block.end());
}

/// The sets of vertices that share a cube and are connected within it. Collects the triangles that are not within one
/// cube in `across`.
DisjointSets clusters_of(const Surface& surface, const Cells& cells, bool is_balanced,
                         HugeVector<std::uint32_t>& across) {
    DisjointSets clusters(cells.size());
    if (!is_balanced) { // otherwise seams would open
        const std::vector<std::uint32_t> first = weld(surface.positions);
        for (std::uint32_t v = 0; v < first.size(); ++v)
            clusters.join(v, first[v]);
    }
    // Edges of a balanced surface have both directions: only one is visited.
    const std::uint64_t either_way = is_balanced ? 0 : 1;
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
        const std::uint64_t forward = (std::uint64_t{a} - b) >> 63;
        if ((forward | either_way) & one_if_zero(cells[a] ^ cells[b]) & std::uint64_t{!clusters.surely_joined(a, b)})
            clusters.join(a, b);
    };
    across.resize(surface.triangles.size());
    std::size_t count = 0;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        prefetch_corners(surface.triangles, t, cells.data(), clusters.data());
        const auto& [a, b, c] = surface.triangles[t];
        join(a, b);
        join(b, c);
        join(c, a);
        across[count] = static_cast<std::uint32_t>(t);
        count += ((cells[a] ^ cells[b]) | (cells[a] ^ cells[c])) != 0;
    }
    across.resize(count);
    return clusters;
}

}

ClusteredSurface::ClusteredSurface(const Surface& surface, bool is_balanced, double cell) {
    const Cells cells = cells_of(surface.positions, cell);
    HugeVector<std::uint32_t> across;
    const std::vector<std::uint32_t> cluster_of =
        merge(surface.positions, clusters_of(surface, cells, is_balanced, across));
    const double far2 = 12.0 * cell * cell; // twice the diagonal of a cube, squared
    const auto far = [&](std::uint32_t v, std::uint32_t w) {
        const Vec3d offset = positions_[cluster_of[v]] - positions_[cluster_of[w]];
        return glm::dot(offset, offset) > far2;
    };
    const auto is_strut = [&](const Triangle& t) { // if collapsed
        const bool is_short = touch(cells[t[0]], cells[t[1]]) & touch(cells[t[1]], cells[t[2]]);
        return !is_short && (far(t[0], t[1]) || far(t[1], t[2]));
    };
    std::atomic<bool> any_strut{false};
    const auto collapses = [&](const Triangle& t) {
        const std::uint32_t a = cluster_of[t[0]], b = cluster_of[t[1]], c = cluster_of[t[2]];
        return (one_if_zero(a ^ b) | one_if_zero(b ^ c) | one_if_zero(c ^ a)) != 0;
    };
    collect(across.size(), triangles_, [&](std::size_t i, std::vector<Triangle>& kept) {
        prefetch_corners(surface.triangles, across[i], cluster_of.data(), cells.data());
        const Triangle& t = surface.triangles[across[i]];
        if (!collapses(t))
            kept.push_back({cluster_of[t[0]], cluster_of[t[1]], cluster_of[t[2]]});
        else if (is_strut(t))
            any_strut = true;
    });

    // Find the collapsed triangles that no kept triangle covers; this needs all kept triangles.
    std::vector<std::uint8_t> unused(positions_.size(), 1); // new vertices without a kept triangle
    for (const Triangle& t : triangles_)
        for (const std::uint32_t v : t)
            unused[v] = 0;
    if (!any_strut && std::find(unused.begin(), unused.end(), 1) == unused.end())
        return;
    std::vector<std::uint8_t> bare = huge_vector<std::uint8_t>(cluster_of.size()); // vertices of unused clusters
    std::transform(cluster_of.begin(), cluster_of.end(), bare.begin(), [&](std::uint32_t v) { return unused[v]; });
    HugeVector<Triangle> uncovered;
    collect(surface.triangles.size(), uncovered, [&](std::size_t i, std::vector<Triangle>& kept) {
        const Triangle& t = surface.triangles[i];
        if ((bare[t[0]] | bare[t[1]] | bare[t[2]]) != 0 || (any_strut && collapses(t) && is_strut(t)))
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
std::vector<std::uint32_t> ClusteredSurface::merge(std::span<const Vec3d> positions, DisjointSets clusters) {
    std::vector<std::uint32_t> cluster_of = huge_vector<std::uint32_t>(positions.size());
    std::vector<double> counts;
    positions_.reserve(cluster_of.size()); // untouched capacity costs nothing
    for (std::uint32_t v = 0; v < cluster_of.size(); ++v) {
        const std::uint32_t first = clusters.find(v);
        if (first == v) {
            cluster_of[v] = static_cast<std::uint32_t>(counts.size());
            positions_.push_back(positions[v]);
            counts.push_back(1.0);
        } else {
            cluster_of[v] = cluster_of[first];
            positions_[cluster_of[v]] += positions[v];
            counts[cluster_of[v]] += 1.0;
        }
    }
    for (std::size_t v = 0; v < counts.size(); ++v)
        positions_[v] /= counts[v];
    return cluster_of;
}

}
