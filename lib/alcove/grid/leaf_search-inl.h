/// What is nearest to eight voxels at once. Internal to grid/.
///
/// Included once a target of Highway, hence no include guard of the usual kind.

#if defined(ALCOVE_GRID_LEAF_SEARCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ALCOVE_GRID_LEAF_SEARCH_INL_H
#undef ALCOVE_GRID_LEAF_SEARCH_INL_H
#else
#define ALCOVE_GRID_LEAF_SEARCH_INL_H
#endif

#include "alcove/grid/nearest_of_eight-inl.h"
#include "alcove/grid/octant_search-inl.h"
#include "alcove/grid/octants-inl.h"
#include "alcove/grid/sieve.h"

#include <limits>
#include <span>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace alcove {
namespace HWY_NAMESPACE {

/// Looks for what is nearest to eight voxels in the leaves below some nodes, the most promising first.
class LeafSearch {
  public:
    void take_nearest(const TriangleTree& tree, std::span<const std::uint32_t> nodes,
                      const EightPoints& voxels, Sieve& sieve, NearestOfEight& best) {
        for (int lane = 0; lane < eight; lane += lanes)
            store(voxels.from(Index3(0), lane), voxels_, lane);
        limit_by_points(tree, nodes);
        const auto leaves = sieve.sift(tree, nodes, down_to_leaves, [&](std::uint32_t node) HWY_ATTR {
            // Its row stands beside its share; without one, the next node takes the row.
            const std::size_t row = sieve.shares().all().size();
            measure(tree.nodes[node], row);
            return wanting(best, row);
        });
        if (leaves.empty())
            return;
        const auto group = [&](std::size_t leaf) { return tree.nodes[leaves[leaf].what].child; };
        find_nearest(leaves.size());
        search_.begin(voxels);
        for (int i = 0; i < eight; ++i)
            if (Row& row = rows_[nearest_[i]]; row.least2[i] <= best.distance2[i]) {
                search_.look(tree, group(nearest_[i]));
                search_.take_nearest(tree, best);
                row = done;
            }
        for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
            std::uint32_t bits = wanting(best, leaf);
            if (std::popcount(bits) > few) {
                search_.look(tree, group(leaf));
                continue;
            }
            for (; bits != 0; bits &= bits - 1)
                best.take_for(std::countr_zero(bits), tree.triangles[group(leaf)], voxels);
        }
        search_.take_others(tree, best);
    }

  private:
    struct Row {
        alignas(4 * eight) float least2[eight];
    };
    static constexpr float never = std::numeric_limits<float>::infinity();
    static constexpr Row done{{never, never, never, never, never, never, never, never}};
    // Voxels that one after the other are measured from a group in the time that it takes to look at it from their
    // centre and to measure from what that leaves of it.
    static constexpr int few = 3;

    void limit_by_points(const TriangleTree& tree, std::span<const std::uint32_t> nodes) {
        for (int lane = 0; lane < eight; lane += lanes) {
            const Vec3v at = load(voxels_, lane);
            V least = hn::Set(d, std::numeric_limits<float>::infinity());
            for (const std::uint32_t node : nodes)
                least = hn::Min(least, length2(minus(at, everywhere(tree.nodes[node].point))));
            hn::Store(least, d, points_ + lane);
        }
    }

    HWY_INLINE void measure(const Bounds& bounds, std::size_t row) {
        if (row >= rows_.size())
            rows_.resize(2 * row + eight);
        for (int lane = 0; lane < eight; lane += lanes)
            hn::Store(distance2(bounds, load(voxels_, lane)), d, rows_[row].least2 + lane);
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
    OctantSearch search_;
    std::vector<Row> rows_;                    // a leaf each: squared distances that it has at least
    alignas(64) std::uint32_t nearest_[eight]; // rows
};

}
}
HWY_AFTER_NAMESPACE();

#endif
