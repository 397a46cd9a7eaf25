#include "alcove/grid/nearest.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alcove/grid/nearest.cpp"
#include <hwy/foreach_target.h> // compiles this file once a target
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace alcove {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int eight = TriangleGroup::size;
using D = hn::CappedTag<float, eight>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
constexpr D d;
// Nodes are kept when they are this much too far, against rounding.
constexpr float slack = 1.0f + 1e-5f;
constexpr float tiny = 1e-30f; // instead of the squared length of a side that has none

struct Vec3v {
    V x, y, z;
};

HWY_INLINE Vec3v load(const float (&v)[3][eight], int lane) {
    return {hn::Load(d, v[0] + lane), hn::Load(d, v[1] + lane), hn::Load(d, v[2] + lane)};
}

HWY_INLINE V dot(const Vec3v& a, const Vec3v& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

HWY_INLINE Vec3v minus(const Vec3v& a, const Vec3v& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

/// a − s b
HWY_INLINE Vec3v less(const Vec3v& a, V s, const Vec3v& b) {
    return {hn::NegMulAdd(s, b.x, a.x), hn::NegMulAdd(s, b.y, a.y), hn::NegMulAdd(s, b.z, a.z)};
}

HWY_INLINE V reciprocal(V v) {
    return hn::Div(hn::Set(d, 1.0f), hn::Max(v, hn::Set(d, tiny)));
}

HWY_INLINE V clamp01(V v) {
    return hn::Min(hn::Max(v, hn::Zero(d)), hn::Set(d, 1.0f));
}

/// Bounds on the distance from p to what some nodes hold.
struct Range {
    V near2; // squared
    V far;
};

HWY_INLINE V height_over(const BoundsGroup& g, int lane, const Vec3v& way) {
    return hn::Abs(dot(way, load(g.axis, lane)));
}

HWY_INLINE V across_axis(const Vec3v& way, V height) {
    return hn::Sqrt(hn::Max(hn::NegMulAdd(height, height, dot(way, way)), hn::Zero(d)));
}

HWY_INLINE V square(V v) {
    return hn::Mul(v, v);
}

/// Distance to the cylinders, squared.
HWY_INLINE V near2(const BoundsGroup& g, int lane, V height, V across) {
    const V beyond = hn::Max(hn::Sub(height, hn::Load(d, g.thickness + lane)), hn::Zero(d));
    const V beside = hn::Max(hn::Sub(across, hn::Load(d, g.radius + lane)), hn::Zero(d));
    return hn::MulAdd(beyond, beyond, square(beside));
}

HWY_INLINE Range range(const BoundsGroup& g, int lane, const Vec3v& p) {
    const Vec3v way = minus(p, load(g.centre, lane));
    const V height = height_over(g, lane, way);
    const V across = across_axis(way, height);
    const V top = hn::Add(height, hn::Load(d, g.thickness + lane));
    const V rim = hn::Add(across, hn::Load(d, g.radius + lane));
    return {near2(g, lane, height, across), hn::Sqrt(hn::MulAdd(top, top, square(rim)))};
}

HWY_INLINE std::uint32_t bits_of(M mask) {
    alignas(64) std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    return bytes[0];
}

HWY_INLINE Vec3v everywhere(float x, float y, float z) {
    return {hn::Set(d, x), hn::Set(d, y), hn::Set(d, z)};
}

HWY_INLINE Vec3v voxel(const Index3& at) {
    return everywhere(static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z));
}

void refine_block(const TriangleTree& tree, const Nodes* nodes, std::size_t count, const Block& block,
                  float reach, std::vector<Nodes>& out) {
    const int lanes = static_cast<int>(hn::Lanes(d));
    const float half = 0.5f * static_cast<float>((block.size - 1) * block.stride);
    const float radius = half * 1.7320508f;
    const auto centre = [&](int low) {
        return static_cast<float>(low) * static_cast<float>(block.stride) + half;
    };
    const Vec3v p = everywhere(centre(block.low.x), centre(block.low.y), centre(block.low.z));

    V far = hn::Set(d, reach);
    for (std::size_t n = 0; n < count; ++n)
        for (int lane = 0; lane < eight; lane += lanes)
            far = hn::Min(far, hn::Add(range(tree.bounds[nodes[n].group], lane, p).far, hn::Set(d, radius)));
    // A voxel is at most `radius` from the centre, and so is its nearest triangle from what is found there.
    float bound = hn::GetLane(hn::MinOfLanes(d, far)) + radius;
    const V open = hn::Set(d, radius);

    out.clear();
    Nodes stack[eight * 24];
    for (std::size_t n = 0; n < count; ++n) {
        int depth = 0;
        stack[depth++] = nodes[n];
        while (depth > 0) {
            const Nodes now = stack[--depth];
            const BoundsGroup& g = tree.bounds[now.group];
            std::uint32_t kept = 0, large = 0;
            for (int lane = 0; lane < eight; lane += lanes) {
                const Range r = range(g, lane, p);
                const V far_enough = hn::Set(d, bound * bound * slack);
                kept |= bits_of(hn::Le(r.near2, far_enough)) << lane;
                large |= bits_of(hn::Gt(hn::Load(d, g.radius + lane), open)) << lane;
                bound = std::min(bound, hn::GetLane(hn::MinOfLanes(d, r.far)) + 2.0f * radius);
            }
            kept &= now.bits;
            large &= kept;
            if (now.group < tree.leaves)
                large = 0;
            if (kept != large)
                out.push_back({now.group, kept & ~large});
            for (; large != 0; large &= large - 1)
                stack[depth++] = {g.child[std::countr_zero(large)], 0xff};
        }
    }
}

/// Squared distances to eight triangles, C. Ericson, "Real-Time Collision Detection" (2005), 5.1.5, without
/// branches: the best of the three sides and of the foot of the perpendicular where it is inside. Whatever
/// rounding does to slivers, each is the distance to a point of the triangle.
HWY_INLINE V distance2(const TriangleGroup& g, int lane, const Vec3v& from_origin) {
    const Vec3v w = minus(from_origin, load(g.a, lane));
    const Vec3v ab = load(g.ab, lane), ac = load(g.ac, lane), bc = minus(ac, ab);
    const V along_ab = hn::Mul(dot(w, ab), reciprocal(dot(ab, ab)));
    const Vec3v from_ab = less(w, clamp01(along_ab), ab);
    const V along_ac = hn::Mul(dot(w, ac), reciprocal(dot(ac, ac)));
    const Vec3v from_ac = less(w, clamp01(along_ac), ac);
    const Vec3v wb = minus(w, ab);
    const Vec3v from_bc = less(wb, clamp01(hn::Mul(dot(wb, bc), reciprocal(dot(bc, bc)))), bc);

    // Orthogonal coordinates in the plane: along ab and along the height over it.
    const V shear = hn::Mul(dot(ac, ab), reciprocal(dot(ab, ab)));
    const Vec3v height = less(ac, shear, ab);
    const V t = hn::Mul(dot(w, height), reciprocal(dot(height, height)));
    const V s = hn::NegMulAdd(t, shear, along_ab);
    const Vec3v from_plane = less(less(w, along_ab, ab), t, height);
    const V inside = hn::Min(hn::Min(s, t), hn::Sub(hn::Sub(hn::Set(d, 1.0f), s), t));

    const V sides = hn::Min(dot(from_bc, from_bc), hn::Min(dot(from_ab, from_ab), dot(from_ac, from_ac)));
    return hn::IfThenElse(hn::Ge(inside, hn::Zero(d)), hn::Min(dot(from_plane, from_plane), sides), sides);
}

class VoxelSearch {
  public:
    VoxelSearch(const TriangleTree& tree) : tree_(tree) {}

    struct Found {
        float distance2;
        std::uint32_t triangle;
    };

    /// The nearest triangle to a point nearer than the limit, starting with the one found last.
    Found find(const Index3& p, std::span<const Nodes> nodes, float limit) {
        at_ = p;
        best_ = {limit * limit, no_triangle};
        const std::uint32_t last = group_;
        if (last != no_group)
            evaluate(last);
        for (const Nodes& n : nodes)
            visit(n.group, n.bits);
        if (best_.triangle == no_triangle)
            best_.distance2 = std::numeric_limits<float>::infinity();
        return best_;
    }

  private:
    static constexpr std::uint32_t no_triangle = UINT32_MAX, no_group = UINT32_MAX;

    void visit(std::uint32_t group, std::uint32_t bits) {
        const BoundsGroup& g = tree_.bounds[group];
        const int lanes = static_cast<int>(hn::Lanes(d));
        const Vec3v p = voxel(at_);
        alignas(64) float near[eight];
        std::uint32_t nearer = 0;
        for (int lane = 0; lane < eight; lane += lanes) {
            const Vec3v way = minus(p, load(g.centre, lane));
            const V height = height_over(g, lane, way);
            const V n2 = near2(g, lane, height, across_axis(way, height));
            hn::Store(n2, d, near + lane);
            nearer |= bits_of(hn::Le(n2, hn::Set(d, best_.distance2 * slack))) << lane;
        }
        for (nearer &= bits; nearer != 0; nearer &= nearer - 1) {
            const int lane = std::countr_zero(nearer);
            if (near[lane] > best_.distance2 * slack)
                continue;
            if (group < tree_.leaves)
                evaluate(g.child[lane]);
            else
                visit(g.child[lane], 0xff);
        }
    }

    void evaluate(std::uint32_t group) {
        const TriangleGroup& g = tree_.triangles[group];
        const int lanes = static_cast<int>(hn::Lanes(d));
        const Vec3v from_origin = voxel(at_ - g.origin);
        for (int lane = 0; lane < eight; lane += lanes) {
            const V all = alcove::HWY_NAMESPACE::distance2(g, lane, from_origin);
            const V least = hn::MinOfLanes(d, all);
            if (!(hn::GetLane(least) < best_.distance2))
                continue;
            const auto first = static_cast<int>(hn::FindKnownFirstTrue(d, hn::Eq(all, least)));
            best_ = {hn::GetLane(least), g.triangle[lane + first]};
            group_ = group;
        }
    }

    const TriangleTree& tree_;
    Index3 at_{0};
    Found best_{};
    std::uint32_t group_ = no_group; // where the last nearest triangle was
};

void nearest_in_brick(const TriangleTree& tree, const Nodes* nodes, std::size_t count, const Block& brick,
                      const BrickLimits& limits, NearestTriangles& out) {
    std::fill_n(out.distance2, brick_volume, std::numeric_limits<float>::infinity());
    VoxelSearch search(tree);
    std::vector<Nodes> of_half, of_quarter;
    // The furthest that a voxel of a block looks.
    const auto reach = [&](const Index3& low, int size) {
        bool all_inside = true;
        for (int x = low.x; x < low.x + size; ++x)
            for (int y = low.y; y < low.y + size; ++y) {
                const unsigned wanted = ((1u << size) - 1) << low.z;
                all_inside = all_inside && (limits.rows[x * brick_size + y] & wanted) == wanted;
            }
        return all_inside ? limits.inner : limits.outer;
    };
    const auto each_octant = [](const Index3& low, int size, auto&& visit) {
        for (int i = 0; i < 8; ++i)
            visit(low + size * Index3(i >> 2, i >> 1 & 1, i & 1));
    };
    each_octant(Index3(0), 4, [&](const Index3& half) {
        refine_block(tree, nodes, count, {brick.low + half, 4, brick.stride}, reach(half, 4), of_half);
        if (of_half.empty())
            return;
        each_octant(half, 2, [&](const Index3& quarter) {
            refine_block(tree, of_half.data(), of_half.size(), {brick.low + quarter, 2, brick.stride},
                         reach(quarter, 2), of_quarter);
            if (of_quarter.empty())
                return;
            each_octant(quarter, 1, [&](const Index3& voxel) {
                const int row = voxel.x * brick_size + voxel.y;
                const bool inside = (limits.rows[row] >> voxel.z & 1) != 0;
                const auto found = search.find((brick.low + voxel) * brick.stride, of_quarter,
                                               inside ? limits.inner : limits.outer);
                out.distance2[row * brick_size + voxel.z] = found.distance2;
                out.triangle[row * brick_size + voxel.z] = found.triangle;
            });
        });
    });
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alcove {

HWY_EXPORT(refine_block);
HWY_EXPORT(nearest_in_brick);

void refine(const TriangleTree& tree, std::span<const Nodes> nodes, const Block& block, float reach,
            std::vector<Nodes>& out) {
    HWY_DYNAMIC_DISPATCH(refine_block)(tree, nodes.data(), nodes.size(), block, reach, out);
}

void nearest_triangles(const TriangleTree& tree, std::span<const Nodes> nodes, const Block& brick,
                       const BrickLimits& limits, NearestTriangles& out) {
    HWY_DYNAMIC_DISPATCH(nearest_in_brick)(tree, nodes.data(), nodes.size(), brick, limits, out);
}

}
#endif
