/// The triangles nearest to eight points.
///
/// Included once per Highway target, hence the unusual include guard.

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

/// The nearest triangles found so far for eight voxels.
struct NearestOfEight {
    static constexpr std::uint32_t none = UINT32_MAX;
    alignas(64) float distance2[eight];
    alignas(64) std::uint32_t triangle[eight];

    /// Searches only within `limit`, and only for the voxels with a bit in `needed`.
    NearestOfEight(float limit, std::uint32_t needed) {
        for (int i = 0; i < eight; ++i) {
            distance2[i] = (needed >> i & 1) != 0 ? limit * limit : -1.0f;
            triangle[i] = none;
        }
    }

    /// Measures triangles of any leaves, each given as 8 · leaf + slot.
    HWY_INLINE void update(const TriangleTree& tree, std::span<const std::uint32_t> triangles,
                           const EightPoints& voxels) {
        for (int lane = 0; lane < eight; lane += lanes) {
            V best = hn::Load(d, distance2 + lane);
            auto index = hn::Load(du, triangle + lane);
            for (const std::uint32_t t : triangles) {
                const TriangleLeaf& g = tree.triangles[t / eight];
                const V found = alcove::HWY_NAMESPACE::distance2(g, t % eight, voxels.from(g.origin, lane));
                const M nearer = hn::Lt(found, best);
                best = hn::IfThenElse(nearer, found, best);
                index = hn::IfThenElse(hn::RebindMask(du, nearer), hn::Set(du, g.triangle[t % eight]), index);
            }
            hn::Store(best, d, distance2 + lane);
            hn::Store(index, du, triangle + lane);
        }
    }

    /// Measures all triangles of a leaf from one voxel. Branch-free, as whether one is nearer is unpredictable.
    HWY_INLINE void update_voxel(int voxel, const TriangleLeaf& g, const EightPoints& voxels) {
        const Vec3v p = voxels.one(g.origin, voxel);
        for (int lane = 0; lane < eight; lane += lanes) {
            const V found = distances2(g, lane, p), least = hn::MinOfLanes(d, found);
            const auto i = static_cast<std::uint32_t>(lane + hn::FindFirstTrue(d, hn::Eq(found, least))) % eight;
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
