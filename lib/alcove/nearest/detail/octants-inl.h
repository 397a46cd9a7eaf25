/// What of a surface can be nearest to the voxels of a block's octants. Internal to grid/.
///
/// Included once a target of Highway, hence no include guard of the usual kind.

#if defined(ALCOVE_GRID_OCTANTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ALCOVE_GRID_OCTANTS_INL_H
#undef ALCOVE_GRID_OCTANTS_INL_H
#else
#define ALCOVE_GRID_OCTANTS_INL_H
#endif

#include "alcove/nearest/detail/triangle_distance-inl.h"

#include <cmath>
#include <limits>
#include <span>

HWY_BEFORE_NAMESPACE();
namespace alcove {
namespace HWY_NAMESPACE {

// Nodes are kept when they are this much too far, against rounding.
constexpr float slack = 1.0f + 1e-5f;
constexpr float diagonal = 1.7320509f; // of a unit cube

HWY_INLINE Vec3v everywhere(const Vec3& v) {
    return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}

/// The ways to points from the nearest point of the cylinder around what a node holds.
HWY_INLINE Vec3v way_from(const Bounds& b, const Vec3v& p) {
    constexpr float tiny = 1e-30f;
    const Vec3v axis = everywhere(b.axis), from_centre = minus(p, everywhere(b.centre));
    const V height = dot(from_centre, axis);
    const Vec3v aside = less(from_centre, height, axis);
    const V across = hn::Sqrt(hn::Max(length2(aside), hn::Set(d, tiny)));
    const V beyond = hn::Max(hn::Sub(hn::Abs(height), hn::Set(d, b.thickness)), hn::Zero(d));
    const V beside = hn::Max(hn::Sub(across, hn::Set(d, b.radius)), hn::Zero(d));
    return less(times(hn::Div(beside, across), aside), hn::Neg(hn::CopySign(beyond, height)), axis);
}

/// Squared distances of points from that cylinder, or a little less. Without the ways, which take a division.
HWY_INLINE V distance2(const Bounds& b, const Vec3v& p) {
    const Vec3v from_centre = minus(p, everywhere(b.centre));
    const V height = dot(from_centre, everywhere(b.axis));
    // Of what is far taller than wide the difference is all rounding: it is made too small rather than too large.
    constexpr float less_rounding = 1.0f - 0x1p-20f;
    const V from_centre2 = hn::Mul(length2(from_centre), hn::Set(d, less_rounding));
    const V across2 = hn::Max(hn::NegMulAdd(height, height, from_centre2), hn::Zero(d));
    const V beyond = hn::Max(hn::Sub(hn::Abs(height), hn::Set(d, b.thickness)), hn::Zero(d));
    const V beside = hn::Max(hn::Sub(hn::Sqrt(across2), hn::Set(d, b.radius)), hn::Zero(d));
    return hn::MulAdd(beyond, beyond, hn::Mul(beside, beside));
}

/// The corners of a cube, x slowest: half of `twice` is the first, half of `twice_apart` the side.
struct EightPoints {
    Index3 twice;
    int twice_apart;

    Vec3 point(int i) const { return 0.5f * Vec3(twice + twice_apart * Index3(i >> 2, i >> 1 & 1, i & 1)); }

    /// From a voxel to the i-th.
    Vec3v one(const Index3& origin, int i) const {
        const float apart = 0.5f * static_cast<float>(twice_apart);
        return everywhere(
            0.5f * static_cast<float>(twice.x - 2 * origin.x) + apart * static_cast<float>(i >> 2),
            0.5f * static_cast<float>(twice.y - 2 * origin.y) + apart * static_cast<float>(i >> 1 & 1),
            0.5f * static_cast<float>(twice.z - 2 * origin.z) + apart * static_cast<float>(i & 1));
    }

    /// From a voxel to those of a vector's lanes.
    HWY_INLINE Vec3v from(const Index3& origin, int lane) const {
        alignas(64) static constexpr float x[eight] = {0, 0, 0, 0, 1, 1, 1, 1},
                                           y[eight] = {0, 0, 1, 1, 0, 0, 1, 1},
                                           z[eight] = {0, 1, 0, 1, 0, 1, 0, 1};
        const V apart = hn::Set(d, 0.5f * static_cast<float>(twice_apart));
        const Vec3v first = everywhere(0.5f * static_cast<float>(twice.x - 2 * origin.x),
                                       0.5f * static_cast<float>(twice.y - 2 * origin.y),
                                       0.5f * static_cast<float>(twice.z - 2 * origin.z));
        return {hn::MulAdd(hn::Load(d, x + lane), apart, first.x),
                hn::MulAdd(hn::Load(d, y + lane), apart, first.y),
                hn::MulAdd(hn::Load(d, z + lane), apart, first.z)};
    }
};

/// Of eight points each: the node that is known to have the nearest point of the surface.
class NearestNodes {
  public:
    alignas(64) float distance2[eight];
    alignas(64) std::uint32_t node[eight];

    NearestNodes(const TriangleTree& tree, std::span<const std::uint32_t> nodes, const EightPoints& points) {
        for (int lane = 0; lane < eight; lane += lanes) {
            const Vec3v p = points.from(Index3(0), lane);
            V best = hn::Set(d, std::numeric_limits<float>::infinity());
            auto nearest = hn::Zero(du);
            for (const std::uint32_t n : nodes) {
                const V found = length2(minus(p, everywhere(tree.nodes[n].point)));
                const M nearer = hn::Lt(found, best);
                best = hn::IfThenElse(nearer, found, best);
                nearest = hn::IfThenElse(hn::RebindMask(du, nearer), hn::Set(du, n), nearest);
            }
            hn::Store(best, d, distance2 + lane);
            hn::Store(nearest, du, node + lane);
        }
    }
};

/// What is known about the surface nearest to the centres of the octants of a block, which tells what cannot be
/// nearest to any of their voxels.
class Octants {
  public:
    /// `half` is that of the way from the first voxel of an octant to its last; `limits` how far from the centres to
    /// look, below 0 where nothing is wanted.
    Octants(const TriangleTree& tree, const EightPoints& centres, float half, const float (&limits)[eight],
            const NearestNodes& nearest)
        : half_(half) {
        for (int i = 0; i < eight; ++i) {
            most_[i] = limits[i] * std::fabs(limits[i]);
            for (int axis = 0; axis < 3; ++axis)
                way_[axis][i] = tree.nodes[nearest.node[i]].point[axis];
        }
        for (int lane = 0; lane < eight; lane += lanes) {
            const Vec3v at = centres.from(Index3(0), lane);
            store(at, at_, lane);
            store(minus(at, load(way_, lane)), way_, lane);
            hn::Store(hn::Load(d, nearest.distance2 + lane), d, distance2_ + lane);
        }
    }

    /// The octants, a bit each, to a voxel of which something of a node may be nearest.
    HWY_INLINE std::uint32_t wanting(const Bounds& bounds) const {
        std::uint32_t wanted = 0;
        for (int lane = 0; lane < eight; lane += lanes)
            wanted |= wanting(way_from(bounds, load(at_, lane)), lane) << lane;
        return wanted;
    }

    /// A way to a centre from some point of the surface.
    void know(int octant, const Vec3& way) {
        const float distance2 = glm::dot(way, way);
        if (distance2 >= distance2_[octant])
            return;
        distance2_[octant] = distance2;
        for (int axis = 0; axis < 3; ++axis)
            way_[axis][octant] = way[axis];
    }

  private:
    /// By the way w to the centre c from the nearest point of something convex. Its squared distance from a voxel v
    /// is convex too, so it is |w|² + 2 (v−c)·w at least; that of the known point at the end of the way w' is
    /// |w'|² + 2 (v−c)·w' + |v−c|².
    HWY_INLINE std::uint32_t wanting(const Vec3v& way, int lane) const {
        const V apart = sum_of_sizes(minus(load(way_, lane), way));
        const V limit = hn::MulAdd(hn::Set(d, 2.0f * half_), apart,
                                   hn::Add(hn::Load(d, distance2_ + lane), hn::Set(d, 3.0f * half_ * half_)));
        return bits_of(
            hn::Le(length2(way), hn::Min(hn::Mul(limit, hn::Set(d, slack)), hn::Load(d, most_ + lane))));
    }

    alignas(64) float at_[3][eight];     // the centres
    alignas(64) float distance2_[eight]; // to the nearest known points
    alignas(64) float way_[3][eight];    // from these
    alignas(64) float most_[eight];
    float half_;
};

}
}
HWY_AFTER_NAMESPACE();

#endif
