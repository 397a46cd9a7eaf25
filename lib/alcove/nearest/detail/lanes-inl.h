/// Operations on eight floats or points, in as many SIMD vectors as the machine needs.
///
/// Included once per Highway target, hence the unusual include guard.

#if defined(ALCOVE_GRID_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ALCOVE_GRID_LANES_INL_H
#undef ALCOVE_GRID_LANES_INL_H
#else
#define ALCOVE_GRID_LANES_INL_H
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace alcove {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int eight = 8;
using D = hn::CappedTag<float, eight>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
constexpr D d;
constexpr hn::RebindToUnsigned<D> du;
constexpr int lanes = static_cast<int>(hn::MaxLanes(d)); // 8, or fewer on machines with smaller vectors

struct Vec3v {
    V x, y, z;
};

HWY_INLINE Vec3v load(const float (&v)[3][eight], int lane) {
    return {hn::Load(d, v[0] + lane), hn::Load(d, v[1] + lane), hn::Load(d, v[2] + lane)};
}

HWY_INLINE void store(const Vec3v& from, float (&v)[3][eight], int lane) {
    hn::Store(from.x, d, v[0] + lane);
    hn::Store(from.y, d, v[1] + lane);
    hn::Store(from.z, d, v[2] + lane);
}

HWY_INLINE Vec3v everywhere(float x, float y, float z) {
    return {hn::Set(d, x), hn::Set(d, y), hn::Set(d, z)};
}

HWY_INLINE V dot(const Vec3v& a, const Vec3v& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

HWY_INLINE V length2(const Vec3v& v) {
    return dot(v, v);
}

HWY_INLINE Vec3v plus(const Vec3v& a, const Vec3v& b) {
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}

HWY_INLINE Vec3v minus(const Vec3v& a, const Vec3v& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

HWY_INLINE Vec3v times(V s, const Vec3v& v) {
    return {hn::Mul(s, v.x), hn::Mul(s, v.y), hn::Mul(s, v.z)};
}

/// a − s b
HWY_INLINE Vec3v minus_scaled(const Vec3v& a, V s, const Vec3v& b) {
    return {hn::NegMulAdd(s, b.x, a.x), hn::NegMulAdd(s, b.y, a.y), hn::NegMulAdd(s, b.z, a.z)};
}

HWY_INLINE Vec3v choose(M mask, const Vec3v& yes, const Vec3v& no) {
    return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y), hn::IfThenElse(mask, yes.z, no.z)};
}

HWY_INLINE V sum_of_abs(const Vec3v& v) {
    return hn::Add(hn::Add(hn::Abs(v.x), hn::Abs(v.y)), hn::Abs(v.z));
}

HWY_INLINE V clamp01(V v) {
    return hn::Min(hn::Max(v, hn::Zero(d)), hn::Set(d, 1.0f));
}

HWY_INLINE std::uint32_t bits_of(M mask) {
    alignas(64) std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    return bytes[0];
}

/// The index of the smallest of eight.
HWY_INLINE int argmin_of_eight(const float (&v)[eight]) {
    V least = hn::Load(d, v);
    for (int lane = lanes; lane < eight; lane += lanes)
        least = hn::Min(least, hn::Load(d, v + lane));
    least = hn::MinOfLanes(d, least);
    std::uint32_t bits = 0;
    for (int lane = 0; lane < eight; lane += lanes)
        bits |= bits_of(hn::Eq(hn::Load(d, v + lane), least)) << lane;
    return std::countr_zero(bits);
}

}
}
HWY_AFTER_NAMESPACE();

#endif
