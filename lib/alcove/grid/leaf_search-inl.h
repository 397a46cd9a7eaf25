/// The leaves of a tree in which something may be nearest to one of eight voxels. Internal to grid/.
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
        for (int lane = 0; lane < eight; lane += lanes)
            store(voxels.from(Index3(0), lane), voxels_, lane);
        limit_by_points(tree, nodes);
        sieve.sift(tree, nodes, down_to_leaves, [&](std::uint32_t node) HWY_ATTR -> std::uint32_t {
            const Bounds& bounds = tree.nodes[node];
            std::uint32_t bits = wanting(best, bounds);
            if (node >= tree.leaves)
                return bits;
            if (node == first)
                return 0;
            if (std::popcount(bits) > few)
                search.look(tree, bounds.child);
            else
                for (; bits != 0; bits &= bits - 1)
                    best.take_for(std::countr_zero(bits), tree.triangles[bounds.child], voxels);
            return 0;
        });
    }

  private:
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

    HWY_INLINE std::uint32_t wanting(const NearestOfEight& best, const Bounds& bounds) const {
        std::uint32_t bits = 0;
        for (int lane = 0; lane < eight; lane += lanes) {
            const V limit = hn::Min(hn::Load(d, best.distance2 + lane), hn::Load(d, points_ + lane));
            const V least = distance2(bounds, load(voxels_, lane));
            bits |= bits_of(hn::Le(least, hn::Mul(limit, hn::Set(d, slack)))) << lane;
        }
        return bits;
    }

    alignas(64) float voxels_[3][eight];
    alignas(64) float points_[eight]; // squared distances of the nearest points that are known of the surface
};

}
}
HWY_AFTER_NAMESPACE();

#endif
