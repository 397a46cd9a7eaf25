/// What is nearest to eight voxels at once. Internal to grid/.
///
/// Included once a target of Highway, hence no include guard of the usual kind.

#if defined(ALCOVE_GRID_LEAF_SEARCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ALCOVE_GRID_LEAF_SEARCH_INL_H
#undef ALCOVE_GRID_LEAF_SEARCH_INL_H
#else
#define ALCOVE_GRID_LEAF_SEARCH_INL_H
#endif

#include "alcove/grid/octants-inl.h"
#include "alcove/grid/sieve.h"

#include <bit>
#include <limits>
#include <span>
#include <vector>

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

    /// One of its triangles, whoever wants it.
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

    /// All of them, for one of the voxels.
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
    std::vector<Row> rows_;           // a leaf each: squared distances that it has at least
    alignas(64) std::uint32_t nearest_[eight]; // rows
};

}
}
HWY_AFTER_NAMESPACE();

#endif
