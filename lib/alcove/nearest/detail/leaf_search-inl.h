/// Searches the leaves of a tree that may contain the triangle nearest to one of eight voxels.
///
/// Included once per Highway target, hence the unusual include guard.

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

/// The leaf below a node that is likely to be nearest to a point.
inline std::uint32_t leaf_near(const TriangleTree& tree, std::uint32_t node, const Vec3& point) {
    while (node >= tree.leaves) {
        const std::uint32_t first = tree.nodes[node].child;
        float least = std::numeric_limits<float>::infinity();
        for (std::uint32_t child = first; child < first + TriangleTree::children; ++child) {
            const Vec3 offset = tree.nodes[child].point - point;
            if (const float found = glm::dot(offset, offset); found < least) {
                least = found;
                node = child;
            }
        }
    }
    return node;
}

/// Descends from nodes to the leaves that may contain the triangle nearest to one of eight voxels.
class LeafSearch {
  public:
    /// Adds the leaves to `octant`, except the node `first`. Leaves needed by at most `few` voxels are evaluated
    /// immediately instead.
    void search(const TriangleTree& tree, std::span<const std::uint32_t> nodes, std::uint32_t first,
                const EightPoints& voxels, Sieve& sieve, OctantSearch& octant, NearestOfEight& best) {
        update_with_likely(tree, nodes, voxels, best);
        for (int lane = 0; lane < eight; lane += lanes)
            store(voxels.from(Index3(0), lane), voxels_, lane);
        sieve.sift(tree, nodes, down_to_leaves,
                   [&](std::uint32_t node) HWY_ATTR { return mask(best, tree.nodes[node]); });
        const MaskedNodes& selected = sieve.selected();
        for (std::size_t k = 0; k < selected.count(); ++k) {
            const std::uint32_t node = selected.node(k), mask = selected.mask(k), leaf = tree.nodes[node].child;
            if (node == first)
                continue;
            if (std::popcount(mask) > few)
                octant.add_leaf(tree, leaf);
            else
                for (std::uint32_t bits = mask; bits != 0; bits &= bits - 1)
                    best.update_voxel(std::countr_zero(bits), tree.triangles[leaf], voxels);
        }
    }

  private:
    // Up to this many voxels, measuring a leaf from each voxel costs no more than measuring it from their centre
    // and then measuring the remaining triangles from the voxels.
    static constexpr int few = 4;

    /// Measures the leaf that is likely to be nearest to each voxel.
    HWY_INLINE static void update_with_likely(const TriangleTree& tree, std::span<const std::uint32_t> nodes,
                                              const EightPoints& voxels, NearestOfEight& best) {
        const NearestNodes near(tree, nodes, voxels);
        for (int i = 0; i < eight; ++i)
            if (best.distance2[i] >= 0.0f) {
                const std::uint32_t leaf = leaf_near(tree, near.node[i], voxels.point(i));
                best.update_voxel(i, tree.triangles[tree.nodes[leaf].child], voxels);
            }
    }

    /// The voxels that need a node, one bit each.
    HWY_INLINE std::uint32_t mask(const NearestOfEight& best, const Bounds& bounds) const {
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
