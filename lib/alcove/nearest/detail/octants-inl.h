/// Finds the tree nodes that may be nearest to the voxels of a block's octants.
///
/// Included once per Highway target, hence the unusual include guard.

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

// Margin against rounding: nodes up to this factor too far are kept.
constexpr float slack = 1.0f + 1e-5f;
constexpr float diagonal = 1.7320509f; // of a unit cube

HWY_INLINE Vec3v everywhere(const Vec3& v) {
    return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}

/// The offsets to points from the nearest point of a node's bounding cylinder.
HWY_INLINE Vec3v offset_from(const Bounds& b, const Vec3v& p) {
    constexpr float tiny = 1e-30f;
    const Vec3v axis = everywhere(b.axis), from_centre = minus(p, everywhere(b.centre));
    const V height = dot(from_centre, axis);
    const Vec3v radial = minus_scaled(from_centre, height, axis);
    const V across = hn::Sqrt(hn::Max(length2(radial), hn::Set(d, tiny)));
    const V beyond = hn::Max(hn::Sub(hn::Abs(height), hn::Set(d, b.thickness)), hn::Zero(d));
    const V beside = hn::Max(hn::Sub(across, hn::Set(d, b.radius)), hn::Zero(d));
    return minus_scaled(times(hn::Div(beside, across), radial), hn::Neg(hn::CopySign(beyond, height)), axis);
}

/// Squared distances of points from the bounding cylinder of a node, or slightly less. Avoids the division that
/// offset_from() needs.
HWY_INLINE V distance2(const Bounds& b, const Vec3v& p) {
    const Vec3v from_centre = minus(p, everywhere(b.centre));
    const V height = dot(from_centre, everywhere(b.axis));
    // Far along the axis the difference below is mostly rounding error: make it too small rather than too large.
    constexpr float less_rounding = 1.0f - 0x1p-20f;
    const V from_centre2 = hn::Mul(length2(from_centre), hn::Set(d, less_rounding));
    const V across2 = hn::Max(hn::NegMulAdd(height, height, from_centre2), hn::Zero(d));
    const V beyond = hn::Max(hn::Sub(hn::Abs(height), hn::Set(d, b.thickness)), hn::Zero(d));
    const V beside = hn::Max(hn::Sub(hn::Sqrt(across2), hn::Set(d, b.radius)), hn::Zero(d));
    return hn::MulAdd(beyond, beyond, hn::Mul(beside, beside));
}

/// The corners of a cube, x slowest. The first corner is `twice` / 2, the side is `twice_apart` / 2.
struct EightPoints {
    Index3 twice;
    int twice_apart;

    Vec3 point(int i) const { return 0.5f * Vec3(twice + twice_apart * Index3(i >> 2, i >> 1 & 1, i & 1)); }

    /// The offset from a voxel to corner i.
    Vec3v one(const Index3& origin, int i) const {
        const float apart = 0.5f * static_cast<float>(twice_apart);
        return everywhere(0.5f * static_cast<float>(twice.x - 2 * origin.x) + apart * static_cast<float>(i >> 2),
                          0.5f * static_cast<float>(twice.y - 2 * origin.y) + apart * static_cast<float>(i >> 1 & 1),
                          0.5f * static_cast<float>(twice.z - 2 * origin.z) + apart * static_cast<float>(i & 1));
    }

    /// The offsets from a voxel to the corners from `lane` on.
    HWY_INLINE Vec3v from(const Index3& origin, int lane) const {
        alignas(64) static constexpr float x[eight] = {0, 0, 0, 0, 1, 1, 1, 1}, y[eight] = {0, 0, 1, 1, 0, 0, 1, 1},
                                           z[eight] = {0, 1, 0, 1, 0, 1, 0, 1};
        const V apart = hn::Set(d, 0.5f * static_cast<float>(twice_apart));
        const Vec3v first = everywhere(0.5f * static_cast<float>(twice.x - 2 * origin.x),
                                       0.5f * static_cast<float>(twice.y - 2 * origin.y),
                                       0.5f * static_cast<float>(twice.z - 2 * origin.z));
        return {hn::MulAdd(hn::Load(d, x + lane), apart, first.x), hn::MulAdd(hn::Load(d, y + lane), apart, first.y),
                hn::MulAdd(hn::Load(d, z + lane), apart, first.z)};
    }
};

/// For each of eight points, the node whose known surface point (Bounds::point) is nearest.
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

/// The nearest known surface points to the centres of a block's octants. They exclude nodes that cannot be nearest
/// to any voxel of an octant.
class Octants {
  public:
    /// `half` is half the distance along an axis between the first and the last voxel of an octant; `limits` are
    /// the search radii around the centres, negative where no search is needed.
    Octants(const TriangleTree& tree, const EightPoints& centres, float half, const float (&limits)[eight],
            const NearestNodes& nearest)
        : half_(half) {
        for (int i = 0; i < eight; ++i) {
            limit2_[i] = limits[i] * std::fabs(limits[i]);
            for (int axis = 0; axis < 3; ++axis)
                offset_[axis][i] = tree.nodes[nearest.node[i]].point[axis];
        }
        for (int lane = 0; lane < eight; lane += lanes) {
            const Vec3v at = centres.from(Index3(0), lane);
            store(at, at_, lane);
            store(minus(at, load(offset_, lane)), offset_, lane);
            hn::Store(hn::Load(d, nearest.distance2 + lane), d, distance2_ + lane);
        }
    }

    /// The octants with a voxel to which a node may be nearest, one bit each.
    HWY_INLINE std::uint32_t mask(const Bounds& bounds) const {
        std::uint32_t bits = 0;
        for (int lane = 0; lane < eight; lane += lanes)
            bits |= mask(offset_from(bounds, load(at_, lane)), lane) << lane;
        return bits;
    }

    /// Adds a known surface point, given by the offset from it to the centre of an octant.
    void add_known(int octant, const Vec3& offset) {
        const float distance2 = glm::dot(offset, offset);
        if (distance2 >= distance2_[octant])
            return;
        distance2_[octant] = distance2;
        for (int axis = 0; axis < 3; ++axis)
            offset_[axis][octant] = offset[axis];
    }

  private:
    /// `offset` is w, from the nearest point of a convex set to the centre c. The squared distance of the set from
    /// a voxel v is convex in v, so it is at least |w|² + 2 (v−c)·w; the squared distance of the known point at offset
    /// w' is |w'|² + 2 (v−c)·w' + |v−c|².
    HWY_INLINE std::uint32_t mask(const Vec3v& offset, int lane) const {
        const V apart = sum_of_abs(minus(load(offset_, lane), offset));
        const V limit = hn::MulAdd(hn::Set(d, 2.0f * half_), apart,
                                   hn::Add(hn::Load(d, distance2_ + lane), hn::Set(d, 3.0f * half_ * half_)));
        return bits_of(
            hn::Le(length2(offset), hn::Min(hn::Mul(limit, hn::Set(d, slack)), hn::Load(d, limit2_ + lane))));
    }

    alignas(64) float at_[3][eight];     // the centres
    alignas(64) float distance2_[eight]; // squared, to the nearest known points
    alignas(64) float offset_[3][eight]; // offsets from these points to the centres
    alignas(64) float limit2_[eight];    // squared search radii, negative for none
    float half_;
};

}
}
HWY_AFTER_NAMESPACE();

#endif
