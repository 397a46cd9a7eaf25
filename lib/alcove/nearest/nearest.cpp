#include "alcove/nearest/nearest.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alcove/nearest/nearest.cpp"
#include <hwy/foreach_target.h> // compiles this file once per target

#include "alcove/nearest/detail/leaf_search-inl.h"
#include "alcove/nearest/detail/octant_search-inl.h"
#include "alcove/nearest/detail/sieve-inl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>

HWY_BEFORE_NAMESPACE();
namespace alcove {
namespace HWY_NAMESPACE {

/// The centres of the octants. If the block has 2³ voxels, these are the voxels themselves.
HWY_INLINE EightPoints octants_of(const Block& block) {
    const int size = block.size / 2;
    return {(2 * block.low + (size - 1)) * block.stride, 2 * size * block.stride};
}

HWY_INLINE float half_of(const Block& block) {
    return 0.5f * static_cast<float>((block.size / 2 - 1) * block.stride);
}

HWY_INLINE Octants known_octants(const TriangleTree& tree, const Block& block, const float (&reach)[eight],
                                 const NearestNodes& nearest) {
    float limits[eight];
    for (int i = 0; i < eight; ++i)
        limits[i] = reach[i] < 0.0f ? -1.0f : (reach[i] + diagonal * half_of(block)) * slack;
    return {tree, octants_of(block), half_of(block), limits, nearest};
}

using Parts = std::array<std::span<const std::uint32_t>, eight>;

/// The nodes of each octant, valid until the next split with this sieve.
HWY_INLINE Parts split_nodes(const TriangleTree& tree, std::span<const std::uint32_t> nodes, const Block& block,
                             const Octants& octants, Sieve& sieve) {
    sieve.sift(tree, nodes, diagonal * half_of(block),
               [&](std::uint32_t node) HWY_ATTR { return octants.mask(tree.nodes[node]); });
    return sieve.selected().per_octant();
}

Parts split_block(const TriangleTree& tree, std::span<const std::uint32_t> nodes, const Block& block,
                  const float (&reach)[eight], Sieve& sieve) {
    const NearestNodes near(tree, nodes, octants_of(block));
    return split_nodes(tree, nodes, block, known_octants(tree, block, reach, near), sieve);
}

void split_once(const TriangleTree& tree, std::span<const std::uint32_t> nodes, const Block& block, float reach,
                std::array<Nodes, eight>& parts) {
    const float reaches[eight] = {reach, reach, reach, reach, reach, reach, reach, reach};
    Sieve sieve;
    const Parts per_octant = split_block(tree, nodes, block, reaches, sieve);
    for (std::size_t i = 0; i < eight; ++i)
        parts[i].assign(per_octant[i].begin(), per_octant[i].end());
}

HWY_INLINE Index3 octant(const Index3& low, int size, int i) {
    return low + size * Index3(i >> 2, i >> 1 & 1, i & 1);
}

/// Buffers for the search of a brick. Each thread reuses them, as allocating them takes longer than filling them.
struct Workspace {
    Sieve of_brick, of_block; // a block of 4³
    LeafSearch leaves;
    std::array<OctantSearch, eight> octants; // of a block of 4³
};

/// Searches the voxels of a brick, from the nodes of the brick down.
class BrickSearch {
  public:
    BrickSearch(const TriangleTree& tree, const Block& brick, const BrickLimits& limits, NearestTriangles& nearest,
                Workspace& work)
        : tree_(tree), brick_(brick), limits_(limits), nearest_(nearest), work_(work) {
        for (std::size_t row = 0; row < brick_rows; ++row) {
            unsigned bits = 0;
            for (unsigned z = 0; z < brick_size; ++z)
                bits |= unsigned{std::isfinite(nearest.distance2[row * brick_size + z])} << z;
            known_[row] = static_cast<std::uint8_t>(bits);
        }
    }

    void search(std::span<const std::uint32_t> nodes) {
        float reach[eight];
        reach_of_octants(Index3(0), brick_size, reach);
        const Parts parts = split_block(tree_, nodes, brick_, reach, work_.of_brick);
        for (int i = 0; i < eight; ++i)
            if (const auto& part = parts[static_cast<std::size_t>(i)]; !part.empty())
                search_octants(part, octant(Index3(0), brick_size / 2, i));
    }

  private:
    /// Searches the voxels of a block of 4³.
    void search_octants(std::span<const std::uint32_t> nodes, const Index3& low) {
        const Block block{brick_.low + low, brick_size / 2, brick_.stride};
        float reach[eight];
        reach_of_octants(low, block.size, reach);
        const EightPoints centres = octants_of(block);
        const NearestNodes near(tree_, nodes, centres);
        Octants octants = known_octants(tree_, block, reach, near);
        std::uint32_t first[eight];
        EightPoints voxels[eight];
        for (int i = 0; i < eight; ++i) {
            if (reach[i] < 0.0f)
                continue;
            voxels[i] = octants_of({octant(block.low, 2, i), 2, block.stride});
            first[i] = leaf_near(tree_, near.node[i], centres.point(i));
            OctantSearch& search = work_.octants[static_cast<std::size_t>(i)];
            search.begin(voxels[i]);
            search.add_leaf(tree_, tree_.nodes[first[i]].child);
            octants.add_known(i, search.nearest_offset());
        }
        const Parts parts = split_nodes(tree_, nodes, block, octants, work_.of_block);
        for (int i = 0; i < eight; ++i) {
            const auto& candidates = parts[static_cast<std::size_t>(i)];
            if (candidates.empty())
                continue;
            const Index3 at = octant(low, 2, i);
            NearestOfEight best(reach[i], needed(at));
            OctantSearch& search = work_.octants[static_cast<std::size_t>(i)];
            search.update_with_nearest(tree_, best);
            if (are_few_leaves(candidates))
                for (const std::uint32_t leaf : candidates) {
                    if (leaf != first[i])
                        search.add_leaf(tree_, tree_.nodes[leaf].child);
                }
            else
                work_.leaves.search(tree_, candidates, first[i], voxels[i], work_.of_block, search, best);
            search.update_with_others(tree_, best);
            store(best, at);
        }
    }

    // Up to this many leaves, computing the distances to all of them costs less than filtering them first (measured on
    // a scan with 1 to 28 triangles per voxel). Inner nodes do not count, as a few of the coarsest contain the whole
    // surface.
    static constexpr std::size_t few_leaves = 24;

    bool are_few_leaves(std::span<const std::uint32_t> nodes) const {
        return nodes.size() <= few_leaves &&
               std::all_of(nodes.begin(), nodes.end(), [&](std::uint32_t node) { return node < tree_.leaves; });
    }

    void store(const NearestOfEight& best, const Index3& low) {
        for (int i = 0; i < eight; ++i) {
            if (best.triangle[i] == NearestOfEight::none)
                continue;
            const Index3 at = octant(low, 1, i);
            nearest_.distance2[voxel_of(at)] = best.distance2[i];
            nearest_.triangle[voxel_of(at)] = best.triangle[i];
        }
    }

    static int voxel_of(const Index3& at) { return (at.x * brick_size + at.y) * brick_size + at.z; }

    /// The voxels of a block of 2³ whose distance is unknown, one bit each.
    std::uint32_t needed(const Index3& low) const {
        std::uint32_t bits = 0;
        for (int i = 0; i < eight; ++i)
            bits |= std::uint32_t{!std::isfinite(nearest_.distance2[voxel_of(octant(low, 1, i))])} << i;
        return bits;
    }

    void reach_of_octants(const Index3& low, int size, float (&reach)[eight]) const {
        for (int i = 0; i < eight; ++i)
            reach[i] = reach_of(octant(low, size / 2, i), size / 2);
    }

    /// The largest search radius in a block of 2³ or 4³ voxels; negative if none needs a search.
    float reach_of(const Index3& low, int size) const {
        const std::uint64_t row = ((std::uint64_t{1} << size) - 1) << low.z, rows = row * 0x0101010101010101;
        const std::uint64_t in_block = rows & ((std::uint64_t{1} << 8 * size) - 1) << 8 * low.y;
        float reach = -1.0f;
        for (int x = low.x; x < low.x + size; ++x) {
            const std::uint64_t needed = in_block & ~slice_of(known_.data(), x);
            if ((slice_of(limits_.rows, x) & needed) != needed)
                return limits_.outer;
            if (needed != 0)
                reach = limits_.inner;
        }
        return reach;
    }

    static std::uint64_t slice_of(const std::uint8_t* rows, int x) {
        std::uint64_t slice; // one byte per row, y = 0 lowest
        static_assert(std::endian::native == std::endian::little);
        std::memcpy(&slice, rows + std::ptrdiff_t{x} * brick_size, sizeof slice);
        return slice;
    }

    const TriangleTree& tree_;
    const Block brick_;
    const BrickLimits limits_;
    NearestTriangles& nearest_;
    std::array<std::uint8_t, brick_rows> known_; // one bit per voxel, as limits_.rows
    Workspace& work_;
};

void nearest_in_brick(const TriangleTree& tree, const Nodes& nodes, const Block& brick, const BrickLimits& limits,
                      NearestTriangles& nearest) {
    thread_local Workspace work;
    BrickSearch(tree, brick, limits, nearest, work).search(nodes);
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alcove {

HWY_EXPORT(split_once);
HWY_EXPORT(nearest_in_brick);

void split(const TriangleTree& tree, const Nodes& nodes, const Block& block, float reach, std::array<Nodes, 8>& parts) {
    HWY_DYNAMIC_DISPATCH(split_once)(tree, nodes, block, reach, parts);
}

void nearest_triangles(const TriangleTree& tree, const Nodes& nodes, const Block& brick, const BrickLimits& limits,
                       NearestTriangles& nearest) {
    HWY_DYNAMIC_DISPATCH(nearest_in_brick)(tree, nodes, brick, limits, nearest);
}

}
#endif
