#include "alcove/grid/nearest.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alcove/grid/nearest.cpp"
#include <hwy/foreach_target.h> // compiles this file once a target
#include <hwy/highway.h>

#include <algorithm>
#include <array>
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
constexpr hn::RebindToUnsigned<D> du;
constexpr int lanes = static_cast<int>(hn::MaxLanes(d)); // all of these vectors have a fixed size
// Nodes are kept when they are this much too far, against rounding.
constexpr float slack = 1.0f + 1e-5f;
constexpr float diagonal = 1.7320509f; // of a unit cube
constexpr float tiny = 1e-30f;         // instead of the squared length of a side that has none

struct Vec3v {
    V x, y, z;
};

HWY_INLINE Vec3v load(const float (&v)[3][eight], int lane) {
    return {hn::Load(d, v[0] + lane), hn::Load(d, v[1] + lane), hn::Load(d, v[2] + lane)};
}

HWY_INLINE V dot(const Vec3v& a, const Vec3v& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

HWY_INLINE V length2(const Vec3v& v) {
    return dot(v, v);
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

/// Squared distances to what some nodes hold, at least: to their cylinders.
HWY_INLINE V near2(const Vec3v& from_centre, const Vec3v& axis, V thickness, V radius) {
    const V height = hn::Abs(dot(from_centre, axis));
    const V across =
        hn::Sqrt(hn::Max(hn::NegMulAdd(height, height, dot(from_centre, from_centre)), hn::Zero(d)));
    const V beyond = hn::Max(hn::Sub(height, thickness), hn::Zero(d));
    const V beside = hn::Max(hn::Sub(across, radius), hn::Zero(d));
    return hn::MulAdd(beyond, beyond, hn::Mul(beside, beside));
}

HWY_INLINE Vec3v everywhere(float x, float y, float z) {
    return {hn::Set(d, x), hn::Set(d, y), hn::Set(d, z)};
}

HWY_INLINE std::uint32_t bits_of(M mask) {
    alignas(64) std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    return bytes[0];
}

/// What of a triangle its distances take, apart from where it is.
struct Shape {
    Vec3v ab, ac, height; // of corner c over ab
    V per_ab, per_ac, per_bc, per_height, shear;
};

HWY_INLINE Shape shape_of(const Vec3v& ab, const Vec3v& ac) {
    const Vec3v bc = minus(ac, ab);
    const V per_ab = reciprocal(dot(ab, ab)), shear = hn::Mul(dot(ac, ab), per_ab);
    const Vec3v height = less(ac, shear, ab);
    return {ab,
            ac,
            height,
            per_ab,
            reciprocal(dot(ac, ac)),
            reciprocal(dot(bc, bc)),
            reciprocal(dot(height, height)),
            shear};
}

/// Squared distance of a triangle from the point at `w` from its corner a: the best of the three sides and of
/// the foot of the perpendicular where it is inside. Whatever rounding does to slivers, each is the distance of
/// a point of the triangle.
HWY_INLINE V distance2(const Vec3v& w, const Shape& t) {
    const V along_ab = hn::Mul(dot(w, t.ab), t.per_ab);
    const V along_ac = hn::Mul(dot(w, t.ac), t.per_ac);
    const Vec3v wb = minus(w, t.ab), bc = minus(t.ac, t.ab);
    const V along_bc = hn::Mul(dot(wb, bc), t.per_bc);
    const V sides =
        hn::Min(length2(less(wb, clamp01(along_bc), bc)), hn::Min(length2(less(w, clamp01(along_ab), t.ab)),
                                                                  length2(less(w, clamp01(along_ac), t.ac))));
    // Orthogonal coordinates in the plane: along ab and along the height.
    const V up = hn::Mul(dot(w, t.height), t.per_height);
    const V along = hn::NegMulAdd(up, t.shear, along_ab);
    const V inside = hn::Min(hn::Min(along, up), hn::Sub(hn::Sub(hn::Set(d, 1.0f), along), up));
    const V plane = length2(less(less(w, along_ab, t.ab), up, t.height));
    return hn::IfThenElse(hn::Ge(inside, hn::Zero(d)), hn::Min(plane, sides), sides);
}

HWY_INLINE Vec3v one(const float (&v)[3][eight], std::uint32_t i) {
    return everywhere(v[0][i], v[1][i], v[2][i]);
}

/// The corners of a cube, x slowest: half of `twice` is the first, half of `twice_apart` the side.
struct EightPoints {
    Index3 twice;
    int twice_apart;

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

    HWY_INLINE V near2_of(const BoundsGroup& g, std::uint32_t i, int lane) const {
        return near2(minus(from(Index3(0), lane), one(g.centre, i)), one(g.axis, i),
                     hn::Set(d, g.thickness[i]), hn::Set(d, g.radius[i]));
    }
};

/// The nearest triangles to eight voxels.
class VoxelSearch {
  public:
    VoxelSearch(const TriangleTree& tree, const EightPoints& voxels) : tree_(tree), voxels_(voxels) {}

    /// Those nearer than the limits.
    void find(const Candidates& from, const float (&limits)[eight]) {
        for (int i = 0; i < eight; ++i) {
            distance2_[i] = limits[i] * limits[i];
            triangle_[i] = none;
        }
        visit(from.nearest);
        for (const std::uint32_t node : from.nodes)
            if (node != from.nearest)
                visit(node);
    }

    float distance2(int i) const {
        return triangle_[i] == none ? std::numeric_limits<float>::infinity() : distance2_[i];
    }
    std::uint32_t triangle(int i) const { return triangle_[i]; }

  private:
    static constexpr std::uint32_t none = UINT32_MAX;

    void visit(std::uint32_t node) {
        const BoundsGroup& g = tree_.bounds[node / eight];
        bool any = false;
        for (int lane = 0; lane < eight; lane += lanes) {
            const V limit = hn::Mul(hn::Load(d, distance2_ + lane), hn::Set(d, slack));
            any = any || !hn::AllFalse(d, hn::Le(voxels_.near2_of(g, node % eight, lane), limit));
        }
        if (!any)
            return;
        const std::uint32_t child = g.child[node % eight];
        if (node / eight < tree_.leaves)
            return evaluate(tree_.triangles[child]);
        for (std::uint32_t i = 0; i < eight; ++i)
            visit(eight * child + i);
    }

    void evaluate(const TriangleGroup& g) {
        alignas(64) float heights[3][eight], per_ab[eight], per_ac[eight], per_bc[eight], per_height[eight],
            shear[eight];
        for (int lane = 0; lane < eight; lane += lanes) {
            const Shape shapes = shape_of(load(g.ab, lane), load(g.ac, lane));
            hn::Store(shapes.height.x, d, heights[0] + lane);
            hn::Store(shapes.height.y, d, heights[1] + lane);
            hn::Store(shapes.height.z, d, heights[2] + lane);
            hn::Store(shapes.per_ab, d, per_ab + lane);
            hn::Store(shapes.per_ac, d, per_ac + lane);
            hn::Store(shapes.per_bc, d, per_bc + lane);
            hn::Store(shapes.per_height, d, per_height + lane);
            hn::Store(shapes.shear, d, shear + lane);
        }
        for (int lane = 0; lane < eight; lane += lanes) {
            const Vec3v p = voxels_.from(g.origin, lane);
            V best = hn::Load(d, distance2_ + lane);
            auto triangle = hn::Load(du, triangle_ + lane);
            for (std::uint32_t i = 0; i < g.count; ++i) {
                const Shape shape{one(g.ab, i),
                                  one(g.ac, i),
                                  one(heights, i),
                                  hn::Set(d, per_ab[i]),
                                  hn::Set(d, per_ac[i]),
                                  hn::Set(d, per_bc[i]),
                                  hn::Set(d, per_height[i]),
                                  hn::Set(d, shear[i])};
                const V found = alcove::HWY_NAMESPACE::distance2(minus(p, one(g.a, i)), shape);
                const M nearer = hn::Lt(found, best);
                best = hn::IfThenElse(nearer, found, best);
                triangle = hn::IfThenElse(hn::RebindMask(du, nearer), hn::Set(du, g.triangle[i]), triangle);
            }
            hn::Store(best, d, distance2_ + lane);
            hn::Store(triangle, du, triangle_ + lane);
        }
    }

    alignas(64) float distance2_[eight];
    alignas(64) std::uint32_t triangle_[eight];
    const TriangleTree& tree_;
    EightPoints voxels_;
};

/// Shares out candidates among the eight octants of a block.
///
/// A point a of the surface is nearer to a voxel v than a point b of it only if
/// |c−a|² − |c−b|² < 2 (v−c)·(a−b), where c is the centre of the octant. With the nearest known point as b, what
/// is far aside of it is out.
class Sharing {
  public:
    /// `half` is that of an octant's side.
    Sharing(const TriangleTree& tree, const EightPoints& centres, float half,
            std::array<Candidates, eight>& parts)
        : tree_(tree), centres_(centres), half_(half), parts_(parts) {}

    /// What is within `limits` of the centres.
    void share_out(const Candidates& from, const float (&limits)[eight]) {
        find_points(from);
        for (int i = 0; i < eight; ++i) {
            most_[i] = limits[i] * limits[i];
            parts_[static_cast<std::size_t>(i)].nodes.clear();
            parts_[static_cast<std::size_t>(i)].nearest = nearest_[i];
        }
        for (const std::uint32_t node : from.nodes)
            share_out(node);
    }

  private:
    void find_points(const Candidates& from) {
        for (int lane = 0; lane < eight; lane += lanes) {
            const Vec3v c = centres_.from(Index3(0), lane);
            V best = hn::Set(d, std::numeric_limits<float>::infinity());
            auto nearest = hn::Zero(du);
            for (const std::uint32_t node : from.nodes) {
                const V distance2 = length2(minus(c, one(tree_.bounds[node / eight].point, node % eight)));
                const M nearer = hn::Lt(distance2, best);
                best = hn::IfThenElse(nearer, distance2, best);
                nearest = hn::IfThenElse(hn::RebindMask(du, nearer), hn::Set(du, node), nearest);
            }
            hn::Store(best, d, distance2_ + lane);
            hn::Store(nearest, du, nearest_ + lane);
        }
        for (int i = 0; i < eight; ++i)
            for (int axis = 0; axis < 3; ++axis)
                point_[axis][i] = tree_.bounds[nearest_[i] / eight].point[axis][nearest_[i] % eight];
    }

    void share_out(std::uint32_t node) {
        const BoundsGroup& g = tree_.bounds[node / eight];
        const std::uint32_t i = node % eight;
        const Vec3v centre = one(g.centre, i);
        std::uint32_t wanted = 0;
        for (int lane = 0; lane < eight; lane += lanes) {
            const Vec3v aside = minus(centre, load(point_, lane));
            const V furthest =
                hn::Add(hn::Add(hn::Abs(aside.x), hn::Abs(aside.y)),
                        hn::Add(hn::Abs(aside.z), hn::Set(d, diagonal * (g.radius[i] + g.thickness[i]))));
            const V limit =
                hn::Mul(hn::MulAdd(hn::Set(d, 2.0f * half_), furthest, hn::Load(d, distance2_ + lane)),
                        hn::Set(d, slack));
            wanted |=
                bits_of(hn::Le(centres_.near2_of(g, i, lane), hn::Min(limit, hn::Load(d, most_ + lane))))
                << lane;
        }
        if (wanted == 0)
            return;
        if (node / eight >= tree_.leaves && g.radius[i] > diagonal * half_) {
            for (std::uint32_t c = 0; c < eight; ++c)
                share_out(eight * g.child[i] + c);
            return;
        }
        for (; wanted != 0; wanted &= wanted - 1)
            parts_[static_cast<std::size_t>(std::countr_zero(wanted))].nodes.push_back(node);
    }

    alignas(64) float distance2_[eight]; // to the points below
    alignas(64) std::uint32_t nearest_[eight];
    alignas(64) float point_[3][eight]; // of the surface
    alignas(64) float most_[eight];
    const TriangleTree& tree_;
    EightPoints centres_;
    float half_;
    std::array<Candidates, eight>& parts_;
};

/// The centres of the octants, themselves voxels where the block is of 2³.
EightPoints octants(const Block& block) {
    const int size = block.size / 2;
    return {(2 * block.low + (size - 1)) * block.stride, 2 * size * block.stride};
}

void split_block(const TriangleTree& tree, const Candidates& from, const Block& block,
                 const float (&reach)[eight], std::array<Candidates, eight>& parts) {
    const float half = 0.5f * static_cast<float>((block.size / 2 - 1) * block.stride);
    float limits[eight];
    for (int i = 0; i < eight; ++i)
        limits[i] = (reach[i] + diagonal * half) * slack;
    Sharing(tree, octants(block), half, parts).share_out(from, limits);
}

Index3 octant(const Index3& low, int size, int i) {
    return low + size * Index3(i >> 2, i >> 1 & 1, i & 1);
}

/// The furthest that a voxel of a block within a brick looks.
float reach_of(const BrickLimits& limits, const Index3& low, int size) {
    bool all_inside = true;
    for (int x = low.x; x < low.x + size; ++x)
        for (int y = low.y; y < low.y + size; ++y) {
            const unsigned wanted = ((1u << size) - 1) << low.z;
            all_inside = all_inside && (limits.rows[x * brick_size + y] & wanted) == wanted;
        }
    return all_inside ? limits.inner : limits.outer;
}

void search_block(const TriangleTree& tree, const Candidates& from, const Block& brick, const Index3& low,
                  int size, const BrickLimits& limits, NearestTriangles& out) {
    const Block block{brick.low + low, size, brick.stride};
    float reach[eight];
    for (int i = 0; i < eight; ++i)
        reach[i] = reach_of(limits, octant(low, size / 2, i), size / 2);
    if (size == 2) {
        VoxelSearch voxels(tree, octants(block));
        voxels.find(from, reach);
        for (int i = 0; i < eight; ++i) {
            const Index3 at = octant(low, 1, i);
            const int voxel = (at.x * brick_size + at.y) * brick_size + at.z;
            out.distance2[voxel] = voxels.distance2(i);
            out.triangle[voxel] = voxels.triangle(i);
        }
        return;
    }
    std::array<Candidates, eight> parts;
    split_block(tree, from, block, reach, parts);
    for (int i = 0; i < eight; ++i)
        if (const Candidates& part = parts[static_cast<std::size_t>(i)]; !part.nodes.empty())
            search_block(tree, part, brick, octant(low, size / 2, i), size / 2, limits, out);
}

void nearest_in_brick(const TriangleTree& tree, const Candidates& from, const Block& brick,
                      const BrickLimits& limits, NearestTriangles& out) {
    std::fill_n(out.distance2, brick_volume, std::numeric_limits<float>::infinity());
    search_block(tree, from, brick, Index3(0), brick_size, limits, out);
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alcove {

HWY_EXPORT(split_block);
HWY_EXPORT(nearest_in_brick);

void split(const TriangleTree& tree, const Candidates& from, const Block& block, float reach,
           std::array<Candidates, 8>& parts) {
    const float alike[8] = {reach, reach, reach, reach, reach, reach, reach, reach};
    HWY_DYNAMIC_DISPATCH(split_block)(tree, from, block, alike, parts);
}

void nearest_triangles(const TriangleTree& tree, const Candidates& from, const Block& brick,
                       const BrickLimits& limits, NearestTriangles& out) {
    HWY_DYNAMIC_DISPATCH(nearest_in_brick)(tree, from, brick, limits, out);
}

}
#endif
