/// The triangles nearest to eight points. Internal to grid/.
///
/// Included once a target of Highway, hence no include guard of the usual kind.

#if defined(ALCOVE_GRID_NEAREST_OF_EIGHT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ALCOVE_GRID_NEAREST_OF_EIGHT_INL_H
#undef ALCOVE_GRID_NEAREST_OF_EIGHT_INL_H
#else
#define ALCOVE_GRID_NEAREST_OF_EIGHT_INL_H
#endif

#include "alcove/nearest/detail/octants-inl.h"

#include <bit>
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

    /// Measures from triangles of any groups: eight times the group, plus the slot.
    HWY_INLINE void take(const TriangleTree& tree, std::span<const std::uint32_t> triangles,
                         const EightPoints& voxels) {
        for (int lane = 0; lane < eight; lane += lanes) {
            V best = hn::Load(d, distance2 + lane);
            auto of = hn::Load(du, triangle + lane);
            for (const std::uint32_t t : triangles) {
                const TriangleLeaf& g = tree.triangles[t / eight];
                const V found = alcove::HWY_NAMESPACE::distance2(g, t % eight, voxels.from(g.origin, lane));
                const M nearer = hn::Lt(found, best);
                best = hn::IfThenElse(nearer, found, best);
                of = hn::IfThenElse(hn::RebindMask(du, nearer), hn::Set(du, g.triangle[t % eight]), of);
            }
            hn::Store(best, d, distance2 + lane);
            hn::Store(of, du, triangle + lane);
        }
    }

    /// Measures from all of a group to one of the voxels. Whether one is nearer, no machine predicts: without a branch.
    HWY_INLINE void take_for(int voxel, const TriangleLeaf& g, const EightPoints& voxels) {
        const Vec3v p = voxels.one(g.origin, voxel);
        for (int lane = 0; lane < eight; lane += lanes) {
            const V found = distances2(g, lane, p), least = hn::MinOfLanes(d, found);
            const auto i =
                static_cast<std::uint32_t>(lane + hn::FindFirstTrue(d, hn::Eq(found, least))) % eight;
            const bool nearer = hn::GetLane(least) < distance2[voxel];
            distance2[voxel] = nearer ? hn::GetLane(least) : distance2[voxel];
            triangle[voxel] = nearer ? g.triangle[i] : triangle[voxel];
        }
    }
};

}
}
HWY_AFTER_NAMESPACE();

#endif
