#include "alcove/grid/nearest.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alcove/grid/nearest.cpp"
#include <hwy/foreach_target.h> // compiles this file once a target

#include "alcove/grid/octants-inl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

HWY_BEFORE_NAMESPACE();
namespace alcove {
namespace HWY_NAMESPACE {

/// The best of what was looked at from eight voxels.
struct NearestOfEight {
    static constexpr std::uint32_t none = UINT32_MAX;
    alignas(64) float distance2[eight];
    alignas(64) std::uint32_t triangle[eight];

    /// Only what is nearer than the limit, and nothing where there is no need.
    NearestOfEight(float limit, std::uint32_t needed) {
        for (int i = 0; i < eight; ++i) {
            distance2[i] = (needed >> i & 1) != 0 ? limit * limit : -1.0f;
            triangle[i] = none;
        }
    }

    /// All triangles of a group, where the bits of `wanting` name voxels that may be nearer to it than to others.
    void take(const TriangleGroup& g, std::uint32_t wanting, const EightPoints& voxels) {
        // One triangle and eight voxels at a time, or eight triangles where few voxels want them.
        if (static_cast<std::uint32_t>(std::popcount(wanting)) > (g.count + 1) / 2) {
            for (std::uint32_t i = 0; i < g.count; ++i)
                take_one(g, i, voxels);
            return;
        }
        for (; wanting != 0; wanting &= wanting - 1)
            take_for(std::countr_zero(wanting), g, voxels);
    }

    HWY_INLINE void take_one(const TriangleGroup& g, std::uint32_t i, const EightPoints& voxels) {
        for (int lane = 0; lane < eight; lane += lanes) {
            const V found = alcove::HWY_NAMESPACE::distance2(g, i, voxels.from(g.origin, lane));
            const V best = hn::Load(d, distance2 + lane);
            const M nearer = hn::Lt(found, best);
            hn::Store(hn::IfThenElse(nearer, found, best), d, distance2 + lane);
            hn::Store(hn::IfThenElse(hn::RebindMask(du, nearer), hn::Set(du, g.triangle[i]),
                                     hn::Load(du, triangle + lane)),
                      du, triangle + lane);
        }
    }

    /// Likewise, for one of the voxels.
    HWY_INLINE void take_for(int voxel, const TriangleGroup& g, const EightPoints& voxels) {
        const Vec3v p = voxels.one(g.origin, voxel);
        for (int lane = 0; lane < eight; lane += lanes) {
            const V found = distances2(g, lane, p), least = hn::MinOfLanes(d, found);
            if (hn::GetLane(least) < distance2[voxel]) {
                distance2[voxel] = hn::GetLane(least);
                triangle[voxel] = g.triangle[lane + hn::FindFirstTrue(d, hn::Eq(found, least))];
            }
        }
    }
};

/// Hands the wanted leaves of some nodes on, the most promising first: after these little is left of the others.
template <class Wanting, class Take>
void take_wanted(const TriangleTree& tree, std::span<const std::uint32_t> nodes, const NearestNodes& first,
                 Sieve& sieve, const Wanting& wanting, const Take& take) {
    constexpr float any = -1.0f; // radius: down to the leaves
    take(sieve.sift(tree, first.nodes(), any, wanting));
    take(sieve.sift(tree, nodes, any,
                    [&](std::uint32_t node) HWY_ATTR { return first.has(node) ? 0 : wanting(node); }));
}

/// Looks for what is nearest to eight voxels in the leaves below some nodes, the most promising first.
class LeafSearch {
  public:
    void take_nearest(const TriangleTree& tree, std::span<const std::uint32_t> nodes,
                      const EightPoints& voxels, Sieve& sieve, NearestOfEight& best) {
        for (int lane = 0; lane < eight; lane += lanes)
            store(voxels.from(Index3(0), lane), voxels_, lane);
        limit_by_points(tree, nodes);
        constexpr float any = -1.0f; // radius: down to the leaves
        const auto leaves = sieve.sift(tree, nodes, any, [&](std::uint32_t node) HWY_ATTR {
            return wanting(tree.nodes[node], best, sieve.shares().all().size());
        });
        if (leaves.empty())
            return;
        const auto group = [&](std::size_t leaf) -> const TriangleGroup& {
            return tree.triangles[tree.nodes[leaves[leaf].what].child];
        };
        find_nearest(leaves.size());
        for (int i = 0; i < eight; ++i)
            if (float& least2 = rows_[nearest_[i]].least2[i]; least2 <= best.distance2[i]) {
                best.take_for(i, group(nearest_[i]), voxels);
                least2 = std::numeric_limits<float>::infinity(); // for that one it is done
            }
        for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf)
            if (const std::uint32_t bits = wanting(best, leaf); bits != 0)
                best.take(group(leaf), bits, voxels);
    }

  private:
    struct Row {
        alignas(4 * eight) float least2[eight];
    };

    void limit_by_points(const TriangleTree& tree, std::span<const std::uint32_t> nodes) {
        for (int lane = 0; lane < eight; lane += lanes) {
            const Vec3v at = load(voxels_, lane);
            V least = hn::Set(d, std::numeric_limits<float>::infinity());
            for (const std::uint32_t node : nodes)
                least = hn::Min(least, length2(minus(at, everywhere(tree.nodes[node].point))));
            hn::Store(least, d, points_ + lane);
        }
    }

    HWY_INLINE std::uint32_t wanting(const Bounds& bounds, const NearestOfEight& best, std::size_t row) {
        if (row >= rows_.size())
            rows_.resize(2 * row + eight);
        for (int lane = 0; lane < eight; lane += lanes)
            hn::Store(distance2(bounds, load(voxels_, lane)), d, rows_[row].least2 + lane);
        return wanting(best, row);
    }

    HWY_INLINE std::uint32_t wanting(const NearestOfEight& best, std::size_t row) const {
        std::uint32_t bits = 0;
        for (int lane = 0; lane < eight; lane += lanes) {
            const V limit = hn::Min(hn::Load(d, best.distance2 + lane), hn::Load(d, points_ + lane));
            const V least = hn::Load(d, rows_[row].least2 + lane);
            bits |= bits_of(hn::Le(least, hn::Mul(limit, hn::Set(d, slack)))) << lane;
        }
        return bits;
    }

    /// Of each voxel, the leaf that is the least away.
    void find_nearest(std::size_t count) {
        for (int lane = 0; lane < eight; lane += lanes) {
            V least = hn::Set(d, std::numeric_limits<float>::infinity());
            auto nearest = hn::Zero(du);
            for (std::size_t leaf = 0; leaf < count; ++leaf) {
                const V found = hn::Load(d, rows_[leaf].least2 + lane);
                const M nearer = hn::Lt(found, least);
                least = hn::IfThenElse(nearer, found, least);
                nearest = hn::IfThenElse(hn::RebindMask(du, nearer),
                                         hn::Set(du, static_cast<std::uint32_t>(leaf)), nearest);
            }
            hn::Store(nearest, du, nearest_ + lane);
        }
    }

    alignas(64) float voxels_[3][eight];
    alignas(64) float points_[eight]; // squared distances of the nearest points that are known of the surface
    std::vector<Row> rows_;           // a leaf each: squared distances that it has at least
    alignas(64) std::uint32_t nearest_[eight]; // rows
};

/// The centres of the octants, themselves voxels where the block is of 2³.
EightPoints octants_of(const Block& block) {
    const int size = block.size / 2;
    return {(2 * block.low + (size - 1)) * block.stride, 2 * size * block.stride};
}

float half_of(const Block& block) {
    return 0.5f * static_cast<float>((block.size / 2 - 1) * block.stride);
}

Octants known_octants(const TriangleTree& tree, const Block& block, const float (&reach)[eight],
                      const NearestNodes& nearest) {
    float limits[eight];
    for (int i = 0; i < eight; ++i)
        limits[i] = reach[i] < 0.0f ? -1.0f : (reach[i] + diagonal * half_of(block)) * slack;
    return {tree, octants_of(block), half_of(block), limits, nearest};
}

void split_block(const TriangleTree& tree, std::span<const std::uint32_t> nodes, const Block& block,
                 const float (&reach)[eight], Sieve& sieve, std::array<Nodes, eight>& parts) {
    const Octants octants = known_octants(tree, block, reach, NearestNodes(tree, nodes, octants_of(block)));
    sieve.sift(tree, nodes, diagonal * half_of(block),
               [&](std::uint32_t node) HWY_ATTR { return octants.wanting(tree.nodes[node]); });
    sieve.shares().share_out(parts);
}

void split_once(const TriangleTree& tree, std::span<const std::uint32_t> nodes, const Block& block,
                float reach, std::array<Nodes, eight>& parts) {
    const float alike[eight] = {reach, reach, reach, reach, reach, reach, reach, reach};
    Sieve sieve;
    split_block(tree, nodes, block, alike, sieve, parts);
}

Index3 octant(const Index3& low, int size, int i) {
    return low + size * Index3(i >> 2, i >> 1 & 1, i & 1);
}

/// The voxels of a brick, from its nodes down.
class BrickSearch {
  public:
    BrickSearch(const TriangleTree& tree, const Block& brick, const BrickLimits& limits,
                NearestTriangles& nearest)
        : tree_(tree), brick_(brick), limits_(limits), nearest_(nearest) {
        for (std::size_t row = 0; row < brick_rows; ++row) {
            unsigned bits = 0;
            for (unsigned z = 0; z < brick_size; ++z)
                bits |= unsigned{std::isfinite(nearest.distance2[row * brick_size + z])} << z;
            known_[row] = static_cast<std::uint8_t>(bits);
        }
    }

    void search(std::span<const std::uint32_t> nodes, const Index3& low, int size) {
        const Block block{brick_.low + low, size, brick_.stride};
        if (size == 2) {
            NearestOfEight best(reach_of(low, size), needed(low));
            leaves_.take_nearest(tree_, nodes, octants_of(block), sieve_, best);
            return keep(best, low);
        }
        float reach[eight];
        for (int i = 0; i < eight; ++i)
            reach[i] = reach_of(octant(low, size / 2, i), size / 2);
        if (size == 4 && nodes.size() <= few_nodes && are_leaves(nodes))
            return search_by_triangle(nodes, block, low, reach);
        std::array<Nodes, eight>& parts = parts_[size == brick_size];
        split_block(tree_, nodes, block, reach, sieve_, parts);
        for (int i = 0; i < eight; ++i)
            if (const Nodes& part = parts[static_cast<std::size_t>(i)]; !part.empty())
                search(part, octant(low, size / 2, i), size / 2);
    }

  private:
    // More than this are of several triangles a voxel: to choose among nodes costs less there than among triangles.
    // Measured on a scan with 1 to 28 of them. Nodes that are no leaves may hold far more triangles: on the coarsest
    // levels few hold the whole surface.
    static constexpr std::size_t few_nodes = 64;

    bool are_leaves(std::span<const std::uint32_t> nodes) const {
        return std::all_of(nodes.begin(), nodes.end(),
                           [&](std::uint32_t node) { return node < tree_.leaves; });
    }

    void search_by_triangle(std::span<const std::uint32_t> nodes, const Block& block, const Index3& low,
                            const float (&reach)[eight]) {
        const NearestNodes first(tree_, nodes, octants_of(block));
        Octants octants = known_octants(tree_, block, reach, first);
        triangles_.clear();
        const auto look = [&](std::span<const Shares::Share> shares) HWY_ATTR {
            for (const auto& [node, bits] : shares) {
                const std::uint32_t child = tree_.nodes[node].child;
                const TriangleGroup& g = tree_.triangles[child];
                triangles_.make_room(eight);
                for (std::uint32_t i = 0; i < g.count; ++i)
                    triangles_.add(eight * child + i, octants.look(g, i));
            }
        };
        const auto wanting = [&](std::uint32_t node) HWY_ATTR { return octants.wanting(tree_.nodes[node]); };
        take_wanted(tree_, nodes, first, sieve_, wanting, look);
        triangles_.share_out(wanted_);
        for (int i = 0; i < eight; ++i) {
            const auto& part = wanted_[static_cast<std::size_t>(i)];
            if (part.empty())
                continue;
            const Index3 at = octant(low, 2, i);
            const EightPoints voxels = octants_of({brick_.low + at, 2, brick_.stride});
            NearestOfEight best(reach[i], needed(at));
            for (const std::uint32_t t : part)
                best.take_one(tree_.triangles[t / eight], t % eight, voxels);
            keep(best, at);
        }
    }

    void keep(const NearestOfEight& best, const Index3& low) {
        for (int i = 0; i < eight; ++i) {
            if (best.triangle[i] == NearestOfEight::none)
                continue;
            const Index3 at = octant(low, 1, i);
            nearest_.distance2[voxel_of(at)] = best.distance2[i];
            nearest_.triangle[voxel_of(at)] = best.triangle[i];
        }
    }

    static int voxel_of(const Index3& at) { return (at.x * brick_size + at.y) * brick_size + at.z; }

    /// The voxels of a block of 2³ whose distance is not known, a bit each.
    std::uint32_t needed(const Index3& low) const {
        std::uint32_t bits = 0;
        for (int i = 0; i < eight; ++i)
            bits |= std::uint32_t{!std::isfinite(nearest_.distance2[voxel_of(octant(low, 1, i))])} << i;
        return bits;
    }

    /// The furthest that a voxel of a block of 2³ or 4³ looks; below 0 where none has to.
    float reach_of(const Index3& low, int size) const {
        const std::uint64_t row = ((std::uint64_t{1} << size) - 1) << low.z, rows = row * 0x0101010101010101;
        const std::uint64_t wanted = rows & ((std::uint64_t{1} << 8 * size) - 1) << 8 * low.y;
        float reach = -1.0f;
        for (int x = low.x; x < low.x + size; ++x) {
            const std::uint64_t needed = wanted & ~slice_of(known_.data(), x);
            if ((slice_of(limits_.rows, x) & needed) != needed)
                return limits_.outer;
            if (needed != 0)
                reach = limits_.inner;
        }
        return reach;
    }

    static std::uint64_t slice_of(const std::uint8_t* rows, int x) {
        std::uint64_t slice; // y from the lowest byte on
        static_assert(std::endian::native == std::endian::little);
        std::memcpy(&slice, rows + std::ptrdiff_t{x} * brick_size, sizeof slice);
        return slice;
    }

    const TriangleTree& tree_;
    const Block brick_;
    const BrickLimits limits_;
    NearestTriangles& nearest_;
    std::array<std::uint8_t, brick_rows> known_;    // a bit a voxel, as limits_.rows
    std::array<std::array<Nodes, eight>, 2> parts_; // of blocks of 4³ and of the brick
    Sieve sieve_;
    LeafSearch leaves_;
    Shares triangles_;
    std::array<Nodes, eight> wanted_; // triangles: eight times the group, plus the slot
};

void nearest_in_brick(const TriangleTree& tree, const Nodes& nodes, const Block& brick,
                      const BrickLimits& limits, NearestTriangles& nearest) {
    BrickSearch(tree, brick, limits, nearest).search(nodes, Index3(0), brick_size);
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alcove {

HWY_EXPORT(split_once);
HWY_EXPORT(nearest_in_brick);

void split(const TriangleTree& tree, const Nodes& nodes, const Block& block, float reach,
           std::array<Nodes, 8>& parts) {
    HWY_DYNAMIC_DISPATCH(split_once)(tree, nodes, block, reach, parts);
}

void nearest_triangles(const TriangleTree& tree, const Nodes& nodes, const Block& brick,
                       const BrickLimits& limits, NearestTriangles& nearest) {
    HWY_DYNAMIC_DISPATCH(nearest_in_brick)(tree, nodes, brick, limits, nearest);
}

}
#endif
