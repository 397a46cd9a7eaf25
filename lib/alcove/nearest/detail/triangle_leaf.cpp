#include "alcove/nearest/detail/triangle_leaf.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alcove/nearest/detail/triangle_leaf.cpp"
#include <hwy/foreach_target.h> // compiles this file once per target

#include "alcove/nearest/detail/lanes-inl.h"

#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace alcove {
namespace HWY_NAMESPACE {

HWY_INLINE V inverse(V v) {
    return hn::Div(hn::Set(d, 1.0f),
                   hn::Max(v, hn::Set(d, 1e-30f))); // avoids dividing by the length of a degenerate side
}

// Frames must be identical on every machine: their operations are not fused here, and CMakeLists.txt keeps the compiler
// from fusing them.

HWY_INLINE V unfused_dot(const Vec3v& a, const Vec3v& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

HWY_INLINE Vec3v unfused_cross(const Vec3v& a, const Vec3v& b) {
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

HWY_INLINE V sum_of_squares(V a, V b) {
    return hn::Add(hn::Mul(a, a), hn::Mul(b, b));
}

/// A unit vector perpendicular to u, or some vector if u is zero.
HWY_INLINE Vec3v across(const Vec3v& u) {
    const M steep = hn::Gt(hn::Abs(u.z), hn::Set(d, 0.6f));
    const V other = hn::IfThenElse(steep, u.z, u.y);
    const V scale = inverse(hn::Sqrt(sum_of_squares(u.x, other)));
    const V x = hn::Mul(scale, u.x);
    return {hn::Neg(hn::Mul(scale, other)), hn::IfThenZeroElse(steep, x), hn::IfThenElseZero(steep, x)};
}

/// Sets the frames of the triangles from `lane` on.
HWY_INLINE void set_frames_from(const Corners& corners, int lane, TriangleLeaf& g) {
    const Vec3v a = load(corners.a, lane), ab = load(corners.ab, lane), ac = load(corners.ac, lane);
    const V ab2 = unfused_dot(ab, ab), b = hn::Sqrt(ab2);
    Vec3v u = times(inverse(b), ab);
    u.x = hn::IfThenElse(hn::Gt(ab2, hn::Zero(d)), u.x, hn::Set(d, 1.0f));
    // The height of c. Orthogonalized twice: the first time leaves a rounding error relative to the sides.
    Vec3v height = minus(ac, times(unfused_dot(ac, u), u));
    height = minus(height, times(unfused_dot(height, u), u));
    const V height2 = unfused_dot(height, height);
    const M flat = hn::Le(height2, hn::Mul(hn::Set(d, 1e-12f), unfused_dot(ac, ac)));
    const Vec3v v = choose(flat, across(u), times(inverse(hn::Sqrt(height2)), height)), n = unfused_cross(u, v);
    const V c0 = unfused_dot(ac, u), c1 = hn::IfThenZeroElse(flat, unfused_dot(ac, v)), bc0 = hn::Sub(c0, b);
    const V per_ac2 = inverse(sum_of_squares(c0, c1)), per_bc2 = inverse(sum_of_squares(bc0, c1));
    store(u, g.u, lane);
    store(v, g.v, lane);
    store(n, g.n, lane);
    store({unfused_dot(a, u), unfused_dot(a, v), unfused_dot(a, n)}, g.a, lane);
    hn::Store(b, d, g.b + lane);
    hn::Store(c0, d, g.c[0] + lane);
    hn::Store(c1, d, g.c[1] + lane);
    hn::Store(hn::Mul(c0, per_ac2), d, g.per_ac[0] + lane);
    hn::Store(hn::Mul(c1, per_ac2), d, g.per_ac[1] + lane);
    hn::Store(hn::Mul(bc0, per_bc2), d, g.per_bc[0] + lane);
    hn::Store(hn::Mul(c1, per_bc2), d, g.per_bc[1] + lane);
}

HWY_INLINE float least_of(V v) {
    return hn::GetLane(hn::MinOfLanes(d, v));
}

HWY_INLINE float most_of(V v) {
    return hn::GetLane(hn::MaxOfLanes(d, v));
}

HWY_INLINE float sum_of(V v) {
    return hn::GetLane(hn::SumOfLanes(d, v));
}

/// Bounds relative to the origin of the leaf.
Bounds bounds_of(const Corners& corners) {
    constexpr float nowhere = 1e18f;
    Vec3v least = everywhere(nowhere, nowhere, nowhere), most = everywhere(-nowhere, -nowhere, -nowhere);
    Vec3v normal = everywhere(0.0f, 0.0f, 0.0f);
    for (int lane = 0; lane < eight; lane += lanes) {
        const Vec3v a = load(corners.a, lane), ab = load(corners.ab, lane), ac = load(corners.ac, lane);
        for (const Vec3v& p : {a, plus(a, ab), plus(a, ac)}) {
            least = {hn::Min(least.x, p.x), hn::Min(least.y, p.y), hn::Min(least.z, p.z)};
            most = {hn::Max(most.x, p.x), hn::Max(most.y, p.y), hn::Max(most.z, p.z)};
        }
        normal = plus(normal, unfused_cross(ab, ac));
    }
    Bounds bounds{};
    bounds.centre = 0.5f * Vec3(least_of(least.x) + most_of(most.x), least_of(least.y) + most_of(most.y),
                                least_of(least.z) + most_of(most.z));
    bounds.axis = unit_or_z({sum_of(normal.x), sum_of(normal.y), sum_of(normal.z)});

    const Vec3v centre = everywhere(bounds.centre.x, bounds.centre.y, bounds.centre.z),
                axis = everywhere(bounds.axis.x, bounds.axis.y, bounds.axis.z);
    V low = hn::Set(d, nowhere), high = hn::Set(d, -nowhere), across2 = hn::Zero(d);
    alignas(64) float to_middle2[eight];
    for (int lane = 0; lane < eight; lane += lanes) {
        const Vec3v a = minus(load(corners.a, lane), centre), ab = load(corners.ab, lane), ac = load(corners.ac, lane);
        for (const Vec3v& p : {a, plus(a, ab), plus(a, ac)}) {
            const V along = dot(p, axis);
            low = hn::Min(low, along);
            high = hn::Max(high, along);
            across2 = hn::Max(across2, length2(minus_scaled(p, along, axis)));
        }
        hn::Store(length2(plus(a, times(hn::Set(d, 1.0f / 3.0f), plus(ab, ac)))), d, to_middle2 + lane);
    }
    const int i = argmin_of_eight(to_middle2);
    const auto& [a, ab, ac] = corners;
    bounds.point = Vec3(a[0][i], a[1][i], a[2][i]) +
                   (Vec3(ab[0][i], ab[1][i], ab[2][i]) + Vec3(ac[0][i], ac[1][i], ac[2][i])) / 3.0f;
    const float bottom = least_of(low), top = most_of(high);
    bounds.centre += 0.5f * (bottom + top) * bounds.axis;
    bounds.thickness = 0.5f * (top - bottom);
    bounds.radius = std::sqrt(most_of(across2));
    return bounds;
}

Bounds frames_and_bounds(const Corners& corners, TriangleLeaf& leaf) {
    for (int lane = 0; lane < eight; lane += lanes)
        set_frames_from(corners, lane, leaf);
    Bounds bounds = bounds_of(corners);
    bounds.point += Vec3(leaf.origin);
    bounds.centre += Vec3(leaf.origin);
    return bounds;
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alcove {

HWY_EXPORT(frames_and_bounds);

Bounds set_frames(const Corners& corners, TriangleLeaf& leaf) {
    return HWY_DYNAMIC_DISPATCH(frames_and_bounds)(corners, leaf);
}

}
#endif
