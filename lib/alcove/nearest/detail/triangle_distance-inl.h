/// Distances of triangles stored in their own frames.
///
/// Included once per Highway target, hence the unusual include guard.

#if defined(ALCOVE_GRID_TRIANGLE_DISTANCE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ALCOVE_GRID_TRIANGLE_DISTANCE_INL_H
#undef ALCOVE_GRID_TRIANGLE_DISTANCE_INL_H
#else
#define ALCOVE_GRID_TRIANGLE_DISTANCE_INL_H
#endif

#include "alcove/nearest/detail/lanes-inl.h"
#include "alcove/nearest/detail/triangle_tree.h"

HWY_BEFORE_NAMESPACE();
namespace alcove {
namespace HWY_NAMESPACE {

/// Offsets of a point from the nearest points of the three sides and of the plane, in the frame of the triangle.
struct FromSides {
    V x_ab, x_ac, y_ac, x_bc, y_bc, y, height;
    V ab2, ac2, bc2; ///< squared lengths in the plane
    M inside;        ///< where the nearest point of the plane is inside the triangle
};

/// `of` loads the values of the triangles in the lanes from a row of the leaf.
template <class Of>
HWY_INLINE FromSides from_sides(const TriangleLeaf& g, const Of& of, const Vec3v& p) {
    const auto along = [&](const float(&axis)[3][eight], int k) HWY_ATTR {
        return hn::MulAdd(p.x, of(axis[0]), hn::MulAdd(p.y, of(axis[1]), hn::MulSub(p.z, of(axis[2]), of(g.a[k]))));
    };
    FromSides from;
    const V x = along(g.u, 0), y = along(g.v, 1);
    from.height = along(g.n, 2);
    from.y = y;
    const V zero = hn::Zero(d), b = of(g.b), c0 = of(g.c[0]), c1 = of(g.c[1]);
    const V beyond_b = hn::Sub(x, b), bc0 = hn::Sub(c0, b);
    const auto part = [&](V along_x, const float(&side)[2][eight])
                          HWY_ATTR { return clamp01(hn::MulAdd(along_x, of(side[0]), hn::Mul(y, of(side[1])))); };
    const V on_ac = part(x, g.per_ac), on_bc = part(beyond_b, g.per_bc);
    from.x_ab = hn::Sub(x, hn::Min(hn::Max(x, zero), b));
    from.x_ac = hn::NegMulAdd(on_ac, c0, x);
    from.y_ac = hn::NegMulAdd(on_ac, c1, y);
    from.x_bc = hn::NegMulAdd(on_bc, bc0, beyond_b);
    from.y_bc = hn::NegMulAdd(on_bc, c1, y);
    from.ab2 = hn::MulAdd(from.x_ab, from.x_ab, hn::Mul(y, y));
    from.ac2 = hn::MulAdd(from.x_ac, from.x_ac, hn::Mul(from.y_ac, from.y_ac));
    from.bc2 = hn::MulAdd(from.x_bc, from.x_bc, hn::Mul(from.y_bc, from.y_bc));
    // Left of all sides. False everywhere for a triangle without area.
    const V of_ca = hn::MulSub(c1, x, hn::Mul(c0, y)), of_bc = hn::MulSub(bc0, y, hn::Mul(c1, beyond_b));
    from.inside = hn::Gt(hn::Min(y, hn::Min(of_ca, of_bc)), zero);
    return from;
}

HWY_INLINE V distance2(const FromSides& from) {
    const V beside2 = hn::IfThenZeroElse(from.inside, hn::Min(from.ab2, hn::Min(from.ac2, from.bc2)));
    return hn::MulAdd(from.height, from.height, beside2);
}

/// Squared distances of triangle i from points given relative to the leaf's origin.
HWY_INLINE V distance2(const TriangleLeaf& g, std::uint32_t i, const Vec3v& p) {
    return distance2(from_sides(
        g, [i](const float(&row)[eight]) HWY_ATTR { return hn::Set(d, row[i]); }, p));
}

/// Squared distances between a point and the triangles of a leaf, starting with triangle `lane`.
HWY_INLINE V distances2(const TriangleLeaf& g, int lane, const Vec3v& p) {
    return distance2(from_sides(
        g, [lane](const float(&row)[eight]) HWY_ATTR { return hn::Load(d, row + lane); }, p));
}

/// The offsets from the nearest points of the triangles of a leaf, starting with triangle `lane`, to a point.
HWY_INLINE Vec3v offsets_from(const TriangleLeaf& g, int lane, const Vec3v& p) {
    const auto of = [lane](const float(&row)[eight]) HWY_ATTR { return hn::Load(d, row + lane); };
    const FromSides from = from_sides(g, of, p);
    const M ac = hn::Lt(from.ac2, from.ab2), bc = hn::Lt(from.bc2, hn::Min(from.ab2, from.ac2));
    const V x =
        hn::IfThenZeroElse(from.inside, hn::IfThenElse(bc, from.x_bc, hn::IfThenElse(ac, from.x_ac, from.x_ab)));
    const V y = hn::IfThenZeroElse(from.inside, hn::IfThenElse(bc, from.y_bc, hn::IfThenElse(ac, from.y_ac, from.y)));
    const auto along = [&](int axis) HWY_ATTR {
        return hn::MulAdd(x, of(g.u[axis]), hn::MulAdd(y, of(g.v[axis]), hn::Mul(from.height, of(g.n[axis]))));
    };
    return {along(0), along(1), along(2)};
}

}
}
HWY_AFTER_NAMESPACE();

#endif
