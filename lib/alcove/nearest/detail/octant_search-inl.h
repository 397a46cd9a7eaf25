/// What is nearest to the eight voxels of an octant, by how it lies to the octant's centre. Internal to grid/.
///
/// Included once a target of Highway, hence no include guard of the usual kind.

#if defined(ALCOVE_GRID_OCTANT_SEARCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ALCOVE_GRID_OCTANT_SEARCH_INL_H
#undef ALCOVE_GRID_OCTANT_SEARCH_INL_H
#else
#define ALCOVE_GRID_OCTANT_SEARCH_INL_H
#endif

#include "alcove/nearest/detail/nearest_of_eight-inl.h"
#include "alcove/nearest/detail/octants-inl.h"

#include <bit>
#include <limits>
#include <span>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace alcove {
namespace HWY_NAMESPACE {

/// Looks at triangles from the centre of eight voxels, eight triangles at a time, which leaves few of them to be measured
/// from the voxels.
class OctantSearch {
  public:
    void begin(const EightPoints& voxels) {
        voxels_ = voxels;
        centre_ = {voxels.twice + voxels.twice_apart / 2, 0};
        count_ = 0;
    }

    /// At all triangles of a group.
    HWY_INLINE void look(const TriangleTree& tree, std::uint32_t group) {
        if (count_ == looks_.size())
            looks_.resize(2 * count_ + eight);
        const TriangleLeaf& g = tree.triangles[group];
        const Vec3v at = centre_.one(g.origin, 0);
        Look& look = looks_[count_++];
        look.group = group;
        look.left = (1u << g.count) - 1;
        for (int lane = 0; lane < eight; lane += lanes) {
            const Vec3v way = ways_from(g, lane, at);
            store(way, look.way, lane);
            hn::Store(length2(way), d, look.distance2 + lane);
        }
    }

    /// The way to the centre from the nearest triangle of the last group.
    Vec3 way() const {
        const Look& look = looks_[count_ - 1];
        const int i = least_of_eight(look.distance2);
        return {look.way[0][i], look.way[1][i], look.way[2][i]};
    }

    /// Measures from the nearest triangle of the last group to the centre.
    HWY_INLINE void take_nearest(const TriangleTree& tree, NearestOfEight& best) {
        Look& look = looks_[count_ - 1];
        const auto i = static_cast<std::uint32_t>(least_of_eight(look.distance2));
        const std::uint32_t triangle = eight * look.group + i;
        best.take(tree, {&triangle, 1}, voxels_);
        look.left &= ~(1u << i);
    }

    /// Measures from all others that may be nearer to a voxel than what was found.
    void take_others(const TriangleTree& tree, NearestOfEight& best) {
        best.take(tree, others(best), voxels_);
    }

  private:
    struct Look {
        alignas(4 * eight) float distance2[eight];
        alignas(4 * eight) float way[3][eight]; ///< from the nearest points of triangles
        std::uint32_t group;
        std::uint32_t left; ///< a bit each that was not measured yet
    };

    /// A squared distance is convex, so by the way w to the centre c it is |w|² + 2 (v−c)·w at least from a voxel v.
    HWY_INLINE std::span<const std::uint32_t> others(const NearestOfEight& best) {
        others_.resize(eight * (count_ + 1)); // vectors are written in full
        std::uint32_t* end = others_.data();
        float limits[eight];
        for (int i = 0; i < eight; ++i)
            limits[i] = slack * best.distance2[i];
        const V apart = hn::Set(d, 0.5f * static_cast<float>(voxels_.twice_apart)); // 2 (v−c) along an axis
        for (std::size_t k = 0; k < count_; ++k)
            for (int lane = 0; lane < eight; lane += lanes) {
                const Look& look = looks_[k];
                const Vec3v way = times(apart, load(look.way, lane));
                const V from_centre = hn::Load(d, look.distance2 + lane);
                V beyond = hn::Set(d, std::numeric_limits<float>::infinity());
                for (int i = 0; i < eight; ++i) {
                    const V x = (i & 4) != 0 ? hn::Add(from_centre, way.x) : hn::Sub(from_centre, way.x);
                    const V y = (i & 2) != 0 ? hn::Add(x, way.y) : hn::Sub(x, way.y);
                    const V z = (i & 1) != 0 ? hn::Add(y, way.z) : hn::Sub(y, way.z);
                    beyond = hn::Min(beyond, hn::Sub(z, hn::Set(d, limits[i])));
                }
                const std::uint32_t bits = bits_of(hn::Le(beyond, hn::Zero(d))) & look.left >> lane;
                const std::uint8_t mask[8] = {static_cast<std::uint8_t>(bits)};
                const auto triangles = hn::Add(
                    hn::Iota(du, 0), hn::Set(du, eight * look.group + static_cast<std::uint32_t>(lane)));
                hn::StoreU(hn::Compress(triangles, hn::LoadMaskBits(du, mask)), du, end);
                end += std::popcount(bits);
            }
        return {others_.data(), end};
    }

    EightPoints voxels_, centre_;
    std::vector<Look> looks_;
    std::size_t count_ = 0;
    std::vector<std::uint32_t> others_;
};

}
}
HWY_AFTER_NAMESPACE();

#endif
