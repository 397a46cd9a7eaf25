#include "alcove/nearest/detail/fragment_leaves.h"

#include "alcove/base/detail/morton_sort.h"
#include "alcove/base/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

namespace alcove {
namespace {

/// Maximum number of fragments that are divided into leaves together. More give better leaves but take longer.
constexpr std::uint32_t largest_bin = 16 * largest_leaf;
constexpr double bin_side = 16.0; // voxels: floats must represent a leaf relative to its first voxel

/// Splits a range of the curve into bins, always between octants or cells, until each bin is small enough and
/// within one cube, that is, its keys differ by less than `cube`. A bin that fits in one leaf may span several
/// cubes.
void cut_into_bins(std::span<const FragmentKey> fragments, std::uint32_t begin, std::uint32_t end, std::uint32_t cube,
                   std::vector<std::uint32_t>& ends) {
    const std::uint32_t count = end - begin, differing = fragments[begin].key ^ fragments[end - 1].key;
    if (count <= largest_leaf || (count <= largest_bin && differing < cube))
        return ends.push_back(end);
    std::uint32_t middle = begin + count / 2; // if all fragments are in the same cell
    if (differing != 0) {
        const std::uint32_t bit = std::bit_floor(differing);
        const auto part = fragments.subspan(begin, count);
        const auto upper = std::partition_point(part.begin(), part.end(),
                                                [&](const FragmentKey& fragment) { return (fragment.key & bit) == 0; });
        middle = begin + static_cast<std::uint32_t>(upper - part.begin());
    }
    cut_into_bins(fragments, begin, middle, cube, ends);
    cut_into_bins(fragments, middle, end, cube, ends);
}

struct PlacedFragment {
    std::array<std::uint16_t, 4> cell; // padded with a zero for SIMD
    FragmentKey fragment;
};
using Bin = std::array<PlacedFragment, largest_bin>;
constexpr auto cells_of_bin = static_cast<std::size_t>(bin_side * most_cells_per_voxel); // along an axis

struct Slab {
    std::size_t axis;
    unsigned low;
};

/// The axis along which fragments extend furthest, and their lowest cell along it.
Slab widest_slab(std::span<const PlacedFragment> fragments) {
    auto low = fragments[0].cell, high = low;
    for (const PlacedFragment& fragment : fragments)
        for (std::size_t axis = 0; axis < 4; ++axis) {
            low[axis] = std::min(low[axis], fragment.cell[axis]);
            high[axis] = std::max(high[axis], fragment.cell[axis]);
        }
    std::size_t widest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis)
        if (high[axis] - low[axis] > high[widest] - low[widest])
            widest = axis;
    return {widest, low[widest]};
}

/// Moves the `half` fragments that are lowest along the axis of `slab` to the front; stable, by counting.
void split(std::span<PlacedFragment> fragments, std::size_t half, const Slab& slab, Bin& spare) {
    std::array<std::size_t, cells_of_bin> counts{};
    const auto cell = [&](const PlacedFragment& fragment) { return fragment.cell[slab.axis] - slab.low; };
    for (const PlacedFragment& fragment : fragments)
        ++counts[cell(fragment)];
    std::size_t middle = 0, room = half;
    for (; counts[middle] <= room; ++middle)
        room -= counts[middle];
    std::size_t ends[2] = {0, half};
    for (const PlacedFragment& fragment : fragments) {
        const bool in_middle = cell(fragment) == middle, high = cell(fragment) > middle || (in_middle && room == 0);
        room -= in_middle && !high;
        spare[ends[high]++] = fragment;
    }
    std::copy_n(spare.begin(), fragments.size(), fragments.begin());
}

/// Halves fragments recursively into leaves, all full except the last.
void halve(std::span<PlacedFragment> fragments, Bin& spare) {
    if (fragments.size() <= largest_leaf)
        return;
    const std::size_t leaves = (fragments.size() + largest_leaf - 1) / largest_leaf,
                      half = (leaves + 1) / 2 * largest_leaf;
    split(fragments, half, widest_slab(fragments), spare);
    halve(fragments.first(half), spare);
    halve(fragments.subspan(half), spare);
}

void arrange(std::span<FragmentKey> bin) {
    if (bin.size() <= largest_leaf)
        return;
    Bin placed, spare;
    for (std::size_t i = 0; i < bin.size(); ++i) {
        const auto [z, y, x] = morton_cell(bin[i].key);
        placed[i] = {{z, y, x, 0}, bin[i]};
    }
    halve(std::span(placed).first(bin.size()), spare);
    for (std::size_t i = 0; i < bin.size(); ++i)
        bin[i] = placed[i].fragment;
}

}

HugeVector<std::uint32_t> group_fragments(std::span<FragmentKey> fragments, double cells_per_voxel) {
    HugeVector<std::uint32_t> begins;
    begins.reserve(fragments.size() + 1);
    begins.push_back(0);
    if (fragments.empty())
        return begins;
    const int octaves = std::max(0, std::ilogb(bin_side * cells_per_voxel));
    std::vector<std::uint32_t> ends{0};
    cut_into_bins(fragments, 0, static_cast<std::uint32_t>(fragments.size()), std::uint32_t{1} << 3 * octaves, ends);
    parallel_for(ends.size() - 1, 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t bin = begin; bin < end; ++bin)
            arrange(fragments.subspan(ends[bin], ends[bin + 1] - ends[bin]));
    });
    for (std::size_t bin = 1; bin < ends.size(); ++bin) {
        for (std::uint32_t begin = ends[bin - 1] + largest_leaf; begin < ends[bin]; begin += largest_leaf)
            begins.push_back(begin);
        begins.push_back(ends[bin]);
    }
    return begins;
}

}
