#include "alcove/grid/piece_groups.h"

#include "alcove/morton.h"
#include "alcove/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

namespace alcove {
namespace {

/// Pieces that are cut into groups together. More of them make better groups, and take longer.
constexpr std::uint32_t largest_bin = 16 * largest_group;
constexpr double bin_side = 16.0; // voxels: floats hold a group from its first voxel on

/// Halves a range of the curve, always between octants or cells, until what is left is in one cube, whose keys differ by
/// less than it, and few enough. Of so few that they are one group it does not matter where they are.
void cut_into_bins(std::span<const PieceKey> pieces, std::uint32_t begin, std::uint32_t end,
                   std::uint32_t cube, std::vector<std::uint32_t>& ends) {
    const std::uint32_t count = end - begin, differing = pieces[begin].key ^ pieces[end - 1].key;
    if (count <= largest_group || (count <= largest_bin && differing < cube))
        return ends.push_back(end);
    std::uint32_t middle = begin + count / 2; // of pieces in one and the same cell
    if (differing != 0) {
        const std::uint32_t bit = std::bit_floor(differing);
        const auto part = pieces.subspan(begin, count);
        const auto upper = std::partition_point(
            part.begin(), part.end(), [&](const PieceKey& piece) { return (piece.key & bit) == 0; });
        middle = begin + static_cast<std::uint32_t>(upper - part.begin());
    }
    cut_into_bins(pieces, begin, middle, cube, ends);
    cut_into_bins(pieces, middle, end, cube, ends);
}

struct PlacedPiece {
    std::array<std::uint16_t, 4> cell; // and a zero, for vectors to hold
    PieceKey piece;
};
using Bin = std::array<PlacedPiece, largest_bin>;
constexpr auto cells_of_bin = static_cast<std::size_t>(bin_side * most_cells_per_voxel); // along an axis

struct Slab {
    std::size_t axis;
    unsigned low;
};

/// Around pieces across the axis along which they lie furthest apart.
Slab widest_slab(std::span<const PlacedPiece> pieces) {
    auto low = pieces[0].cell, high = low;
    for (const PlacedPiece& piece : pieces)
        for (std::size_t axis = 0; axis < 4; ++axis) {
            low[axis] = std::min(low[axis], piece.cell[axis]);
            high[axis] = std::max(high[axis], piece.cell[axis]);
        }
    std::size_t widest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis)
        if (high[axis] - low[axis] > high[widest] - low[widest])
            widest = axis;
    return {widest, low[widest]};
}

/// Puts the `half` of pieces that are lowest along an axis before the others, of one cell those that were first.
void split(std::span<PlacedPiece> pieces, std::size_t half, const Slab& slab, Bin& spare) {
    std::array<std::size_t, cells_of_bin> counts{};
    const auto cell = [&](const PlacedPiece& piece) { return piece.cell[slab.axis] - slab.low; };
    for (const PlacedPiece& piece : pieces)
        ++counts[cell(piece)];
    std::size_t middle = 0, room = half;
    for (; counts[middle] <= room; ++middle)
        room -= counts[middle];
    std::size_t ends[2] = {0, half};
    for (const PlacedPiece& piece : pieces) {
        const bool there = cell(piece) == middle, high = cell(piece) > middle || (there && room == 0);
        room -= there && !high;
        spare[ends[high]++] = piece;
    }
    std::copy_n(spare.begin(), pieces.size(), pieces.begin());
}

/// Halves pieces down to groups, all of them full but the last.
void halve(std::span<PlacedPiece> pieces, Bin& spare) {
    if (pieces.size() <= largest_group)
        return;
    const std::size_t groups = (pieces.size() + largest_group - 1) / largest_group,
                      half = (groups + 1) / 2 * largest_group;
    split(pieces, half, widest_slab(pieces), spare);
    halve(pieces.first(half), spare);
    halve(pieces.subspan(half), spare);
}

void arrange(std::span<PieceKey> bin) {
    if (bin.size() <= largest_group)
        return;
    Bin placed, spare;
    for (std::size_t i = 0; i < bin.size(); ++i) {
        const auto [z, y, x] = morton_cell(bin[i].key);
        placed[i] = {{z, y, x, 0}, bin[i]};
    }
    halve(std::span(placed).first(bin.size()), spare);
    for (std::size_t i = 0; i < bin.size(); ++i)
        bin[i] = placed[i].piece;
}

}

HugeVector<std::uint32_t> group_pieces(std::span<PieceKey> pieces, double cells_per_voxel) {
    HugeVector<std::uint32_t> begins;
    begins.reserve(pieces.size() + 1);
    begins.push_back(0);
    if (pieces.empty())
        return begins;
    const int octaves = std::max(0, std::ilogb(bin_side * cells_per_voxel));
    std::vector<std::uint32_t> ends{0};
    cut_into_bins(pieces, 0, static_cast<std::uint32_t>(pieces.size()), std::uint32_t{1} << 3 * octaves,
                  ends);
    parallel_for(ends.size() - 1, 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t bin = begin; bin < end; ++bin)
            arrange(pieces.subspan(ends[bin], ends[bin + 1] - ends[bin]));
    });
    for (std::size_t bin = 1; bin < ends.size(); ++bin) {
        for (std::uint32_t begin = ends[bin - 1] + largest_group; begin < ends[bin]; begin += largest_group)
            begins.push_back(begin);
        begins.push_back(ends[bin]);
    }
    return begins;
}

}
