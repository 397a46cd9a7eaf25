/// Searches for the triangles nearest to the eight voxels of an octant by their offsets from its centre.
///
/// Included once per Highway target, hence the unusual include guard.

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

/// Measures triangles from the centre of eight voxels, eight triangles at a time. The results bound the distances from
/// the voxels, so that few triangles need to be measured from the voxels themselves.
class OctantSearch {
  public:
    void begin(const EightPoints& voxels) {
        voxels_ = voxels;
        centre_ = {voxels.twice + voxels.twice_apart / 2, 0};
        count_ = 0;
    }

    /// Measures all triangles of a leaf from the centre.
    HWY_INLINE void add_leaf(const TriangleTree& tree, std::uint32_t leaf) {
        if (count_ == leaves_.size())
            leaves_.resize(2 * count_ + eight);
        const TriangleLeaf& g = tree.triangles[leaf];
        const Vec3v at = centre_.one(g.origin, 0);
        MeasuredLeaf& measured = leaves_[count_++];
        measured.leaf = leaf;
        measured.pending = (1u << g.count) - 1;
        for (int lane = 0; lane < eight; lane += lanes) {
            const Vec3v offset = offsets_from(g, lane, at);
            store(offset, measured.offset, lane);
            hn::Store(length2(offset), d, measured.distance2 + lane);
        }
    }

    /// The offset to the centre from the nearest point of the last leaf.
    Vec3 nearest_offset() const {
        const MeasuredLeaf& last = leaves_[count_ - 1];
        const int i = argmin_of_eight(last.distance2);
        return {last.offset[0][i], last.offset[1][i], last.offset[2][i]};
    }

    /// Measures the triangle of the last leaf that is nearest to the centre.
    HWY_INLINE void update_with_nearest(const TriangleTree& tree, NearestOfEight& best) {
        MeasuredLeaf& last = leaves_[count_ - 1];
        const auto i = static_cast<std::uint32_t>(argmin_of_eight(last.distance2));
        const std::uint32_t triangle = eight * last.leaf + i;
        best.update(tree, {&triangle, 1}, voxels_);
        last.pending &= ~(1u << i);
    }

    /// Measures the distances to all other triangles that may be nearer to a voxel than the best so far.
    void update_with_others(const TriangleTree& tree, NearestOfEight& best) {
        best.update(tree, others(best), voxels_);
    }

  private:
    struct MeasuredLeaf {
        alignas(4 * eight) float distance2[eight];
        alignas(4 * eight) float offset[3][eight]; ///< to the centre from the nearest points of the triangles
        std::uint32_t leaf;
        std::uint32_t pending; ///< triangles not measured from the voxels yet, one bit each
    };

    /// The triangles that may be nearer than the best so far. With w the offset to the centre c, the squared
    /// distance from a voxel v is at least |w|² + 2 (v−c)·w, as it is convex in v.
    HWY_INLINE std::span<const std::uint32_t> others(const NearestOfEight& best) {
        others_.resize(eight * (count_ + 1)); // vectors are written in full
        std::uint32_t* end = others_.data();
        float limits[eight];
        for (int i = 0; i < eight; ++i)
            limits[i] = slack * best.distance2[i];
        const V apart = hn::Set(d, 0.5f * static_cast<float>(voxels_.twice_apart)); // 2 (v−c) along an axis
        for (std::size_t k = 0; k < count_; ++k)
            for (int lane = 0; lane < eight; lane += lanes) {
                const MeasuredLeaf& measured = leaves_[k];
                const Vec3v slope = times(apart, load(measured.offset, lane));
                const V from_centre = hn::Load(d, measured.distance2 + lane);
                V excess = hn::Set(d, std::numeric_limits<float>::infinity());
                for (int i = 0; i < eight; ++i) {
                    const V x = (i & 4) != 0 ? hn::Add(from_centre, slope.x) : hn::Sub(from_centre, slope.x);
                    const V y = (i & 2) != 0 ? hn::Add(x, slope.y) : hn::Sub(x, slope.y);
                    const V z = (i & 1) != 0 ? hn::Add(y, slope.z) : hn::Sub(y, slope.z);
                    excess = hn::Min(excess, hn::Sub(z, hn::Set(d, limits[i])));
                }
                const std::uint32_t bits = bits_of(hn::Le(excess, hn::Zero(d))) & measured.pending >> lane;
                const std::uint8_t mask[8] = {static_cast<std::uint8_t>(bits)};
                const auto triangles =
                    hn::Add(hn::Iota(du, 0), hn::Set(du, eight * measured.leaf + static_cast<std::uint32_t>(lane)));
                hn::StoreU(hn::Compress(triangles, hn::LoadMaskBits(du, mask)), du, end);
                end += std::popcount(bits);
            }
        return {others_.data(), end};
    }

    EightPoints voxels_, centre_;
    std::vector<MeasuredLeaf> leaves_;
    std::size_t count_ = 0;
    std::vector<std::uint32_t> others_;
};

}
}
HWY_AFTER_NAMESPACE();

#endif
