/// The leaves of a tree in which something may be nearest to one of eight voxels. Internal to grid/.
///
/// Included once a target of Highway, hence no include guard of the usual kind.

#if defined(ALCOVE_GRID_LEAF_SEARCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ALCOVE_GRID_LEAF_SEARCH_INL_H
#undef ALCOVE_GRID_LEAF_SEARCH_INL_H
#else
#define ALCOVE_GRID_LEAF_SEARCH_INL_H
#endif

#include "alcove/nearest/detail/nearest_of_eight-inl.h"
#include "alcove/nearest/detail/octant_search-inl.h"
#include "alcove/nearest/detail/octants-inl.h"
#include "alcove/nearest/detail/sieve-inl.h"

#include <bit>
#include <limits>
#include <span>

HWY_BEFORE_NAMESPACE();
namespace alcove {
namespace HWY_NAMESPACE {

/// The leaf below a node that is likely to be the nearest to a point.
inline std::uint32_t leaf_near(const TriangleTree& tree, std::uint32_t node, const Vec3& point) {
    while (node >= tree.leaves) {
        const std::uint32_t first = tree.nodes[node].child;
        float least = std::numeric_limits<float>::infinity();
        for (std::uint32_t child = first; child < first + TriangleTree::children; ++child) {
            const Vec3 way = tree.nodes[child].point - point;
            if (const float found = glm::dot(way, way); found < least) {
                least = found;
                node = child;
            }
        }
    }
    return node;
}

/// Goes from nodes down to the leaves in which something may be nearest to one of eight voxels.
class LeafSearch {
  public:
    /// Looks at their groups, but for that of the `first` leaf; where few voxels want one, these are measured from at once.
    void look(const TriangleTree& tree, std::span<const std::uint32_t> nodes, std::uint32_t first,
              const EightPoints& voxels, Sieve& sieve, OctantSearch& search, NearestOfEight& best) {
        take_likely(tree, nodes, voxels, best);
        for (int lane = 0; lane < eight; lane += lanes)
            store(voxels.from(Index3(0), lane), voxels_, lane);
        sieve.sift(tree, nodes, down_to_leaves,
                   [&](std::uint32_t node) HWY_ATTR { return wanting(best, tree.nodes[node]); });
        const Shares& shares = sieve.shares();
        for (std::size_t k = 0; k < shares.count(); ++k) {
            const std::uint32_t leaf = shares.what(k), wanting = shares.wanting(k),
                                group = tree.nodes[leaf].child;
            if (leaf == first)
                continue;
            if (std::popcount(wanting) > few)
                search.look(tree, group);
            else
                for (std::uint32_t bits = wanting; bits != 0; bits &= bits - 1)
                    best.take_for(std::countr_zero(bits), tree.triangles[group], voxels);
        }
    }

  private:
    // Voxels that one after the other are measured from a group in the time that it takes to look at it from their
    // centre and to measure from what that leaves of it.
    static constexpr int few = 4;

    /// Measures from the group that is likely to be the nearest to each voxel.
    HWY_INLINE static void take_likely(const TriangleTree& tree, std::span<const std::uint32_t> nodes,
                                       const EightPoints& voxels, NearestOfEight& best) {
        const NearestNodes near(tree, nodes, voxels);
        for (int i = 0; i < eight; ++i)
            if (best.distance2[i] >= 0.0f) {
                const std::uint32_t leaf = leaf_near(tree, near.node[i], voxels.point(i));
                best.take_for(i, tree.triangles[tree.nodes[leaf].child], voxels);
            }
    }

    HWY_INLINE std::uint32_t wanting(const NearestOfEight& best, const Bounds& bounds) const {
        std::uint32_t bits = 0;
        for (int lane = 0; lane < eight; lane += lanes) {
            const V limit = hn::Mul(hn::Load(d, best.distance2 + lane), hn::Set(d, slack));
            bits |= bits_of(hn::Le(distance2(bounds, load(voxels_, lane)), limit)) << lane;
        }
        return bits;
    }

    alignas(64) float voxels_[3][eight];
};

}
}
HWY_AFTER_NAMESPACE();

#endif
