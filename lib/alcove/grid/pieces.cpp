#include "alcove/grid/pieces.h"

#include "alcove/grid/radix_sort.h"
#include "alcove/parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace alcove {
namespace {

constexpr std::size_t grain = 4096; // triangles
constexpr double cells_per_voxel = 4.0;
constexpr double most_cells = (1 << 21) - 1; // along an axis: three times 21 bits are a key

double length2(const Vec3d& v) {
    return glm::dot(v, v);
}

/// Calls `visit(corners)` for each piece of a triangle, corner 0 opposite to the longest side.
template <class Visit>
void cut(const Vec3d& a, const Vec3d& b, const Vec3d& c, Visit&& visit) {
    const double ab = length2(b - a), bc = length2(c - b), ca = length2(a - c);
    if (bc < ab || bc < ca)
        return ab > ca ? cut(c, a, b, visit) : cut(b, c, a, visit);
    if (bc <= longest_piece * longest_piece)
        return visit(a, b, c);
    const Vec3d middle = 0.5 * (b + c);
    cut(a, b, middle, visit);
    cut(a, middle, c, visit);
}

std::uint64_t spread(std::uint64_t x) { // two zero bits after each of 21
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

std::uint64_t morton(const Vec3d& cell) {
    return spread(static_cast<std::uint64_t>(cell.x)) << 2 | spread(static_cast<std::uint64_t>(cell.y)) << 1 |
           spread(static_cast<std::uint64_t>(cell.z));
}

bool has_area(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    return length2(glm::cross(b - a, c - a)) > 0.0;
}

/// Halves a range of the curve, always between octants or cells, until groups are small enough.
void group(std::span<const Keyed> order, std::uint32_t begin, std::uint32_t end,
           std::vector<std::uint32_t>& out) {
    if (end - begin <= GroupedPieces::largest_group) {
        out.push_back(end);
        return;
    }
    const std::uint64_t differing = order[begin].key ^ order[end - 1].key;
    std::uint32_t middle = begin + (end - begin) / 2; // of pieces in one and the same cell
    if (differing != 0) {
        const std::uint64_t bit = std::bit_floor(differing);
        const auto part = order.subspan(begin, end - begin);
        const auto upper = std::partition_point(part.begin(), part.end(),
                                                [&](const Keyed& piece) { return (piece.key & bit) == 0; });
        middle = begin + static_cast<std::uint32_t>(upper - part.begin());
    }
    group(order, begin, middle, out);
    group(order, middle, end, out);
}

}

GroupedPieces grouped_pieces(std::span<const Vec3d> positions, std::span<const Triangle> triangles) {
    const std::size_t blocks = (triangles.size() + grain - 1) / grain;
    const auto for_each_piece = [&](std::size_t t, auto&& visit) {
        const Vec3d &a = positions[triangles[t][0]], &b = positions[triangles[t][1]],
                    &c = positions[triangles[t][2]];
        if (has_area(a, b, c))
            cut(a, b, c, visit);
    };
    std::vector<std::size_t> first(blocks + 1, 0);
    std::vector<double> extents(blocks, 0.0);
    parallel_for(triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
        const std::size_t block = begin / grain;
        for (std::size_t t = begin; t < end; ++t)
            for_each_piece(t, [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
                ++first[block + 1];
                const Vec3d most = glm::max(glm::max(a, b), c);
                extents[block] = std::max({extents[block], most.x, most.y, most.z});
            });
    });
    double extent = 1.0;
    for (std::size_t block = 0; block < blocks; ++block) {
        first[block + 1] += first[block];
        extent = std::max(extent, extents[block]);
    }

    const double scale = std::min(cells_per_voxel, most_cells / extent);
    const int bits = 3 * (std::ilogb(scale * extent) + 1);
    std::vector<Piece> pieces(first.back());
    std::vector<Keyed> order(first.back());
    parallel_for(triangles.size(), grain, [&](std::size_t begin, std::size_t end) {
        std::size_t i = first[begin / grain];
        for (std::size_t t = begin; t < end; ++t)
            for_each_piece(t, [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
                const Vec3d origin = glm::floor(a);
                pieces[i] = {Index3(origin),
                             {Vec3(a - origin), Vec3(b - origin), Vec3(c - origin)},
                             static_cast<std::uint32_t>(t)};
                order[i] = {morton(scale / 3.0 * (a + b + c)), static_cast<std::uint32_t>(i)};
                ++i;
            });
    });
    radix_sort(order, bits);
    GroupedPieces sorted;
    sorted.pieces.resize(pieces.size());
    parallel_for(pieces.size(), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            sorted.pieces[i] = pieces[order[i].value];
    });
    sorted.begin.push_back(0);
    if (!order.empty())
        group(order, 0, static_cast<std::uint32_t>(order.size()), sorted.begin);
    return sorted;
}

}
