#include "alcove/field/detail/bricks.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alcove/field/detail/sample_bricks.cpp"
#include <hwy/foreach_target.h> // compiles this file once per target
#include <hwy/highway.h>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace alcove {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int samples = BrickView::samples;

/// Splits one coordinate into the index of the sample below it and the fraction beyond that sample.
template <class D, class V = hn::Vec<D>, class I = hn::Vec<hn::RebindToSigned<D>>>
HWY_INLINE void locate(D d, V p, float scale, float offset, std::int32_t bricks, I& cell, V& t) {
    const V last = hn::Set(d, static_cast<float>(bricks * BrickView::cells - 1));
    const V q = hn::Min(hn::Max(hn::MulAdd(p, hn::Set(d, scale), hn::Set(d, offset)), hn::Zero(d)), last);
    cell = hn::ConvertTo(hn::RebindToSigned<D>(), q); // truncates: q is not negative
    t = hn::Sub(q, hn::ConvertTo(d, cell));
}

/// a = values[at], b = values[at + 1].
template <class D, class V = hn::Vec<D>, class I = hn::Vec<hn::RebindToSigned<D>>>
HWY_INLINE void gather_pair(D d, const float* values, I at, V& a, V& b) {
#if HWY_TARGET == HWY_SCALAR
    a = hn::GatherIndex(d, values, at);
    b = hn::GatherIndex(d, values + 1, at);
#else
    // Loading both values with one 64-bit gather halves the number of gathers.
    const hn::Repartition<std::int64_t, D> wide;
    const hn::Half<hn::RebindToSigned<D>> half;
    const auto* pairs = reinterpret_cast<const std::int64_t*>(values);
    const auto lower = hn::ShiftLeft<2>(hn::PromoteTo(wide, hn::LowerHalf(half, at)));
    const auto upper = hn::ShiftLeft<2>(hn::PromoteTo(wide, hn::UpperHalf(half, at)));
    const V low = hn::BitCast(d, hn::GatherOffset(wide, pairs, lower));
    const V high = hn::BitCast(d, hn::GatherOffset(wide, pairs, upper));
    a = hn::ConcatEven(d, high, low);
    b = hn::ConcatOdd(d, high, low);
#endif
}

template <class D>
HWY_INLINE void sample(D d, const BrickView& view, const float* x, const float* y, const float* z, float* distances) {
    const hn::RebindToSigned<D> di;
    using V = hn::Vec<D>;
    using I = hn::Vec<decltype(di)>;
    I ix, iy, iz;
    V tx, ty, tz;
    locate(d, hn::LoadU(d, x), view.scale, view.offset[0], view.size[0], ix, tx);
    locate(d, hn::LoadU(d, y), view.scale, view.offset[1], view.size[1], iy, ty);
    locate(d, hn::LoadU(d, z), view.scale, view.offset[2], view.size[2], iz, tz);

    const I in_brick = hn::Set(di, BrickView::cells - 1);
    const I brick =
        hn::Add(hn::Mul(hn::Add(hn::Mul(hn::ShiftRight<3>(ix), hn::Set(di, view.size[1])), hn::ShiftRight<3>(iy)),
                        hn::Set(di, view.size[2])),
                hn::ShiftRight<3>(iz));
    const I local =
        hn::Add(hn::Mul(hn::Add(hn::Mul(hn::And(ix, in_brick), hn::Set(di, samples)), hn::And(iy, in_brick)),
                        hn::Set(di, samples)),
                hn::And(iz, in_brick));
    const I corner = hn::Add(hn::GatherIndex(di, view.index, brick), local);

    const auto along_z = [&](int at) HWY_ATTR {
        V a, b;
        gather_pair(d, view.bricks + at, corner, a, b);
        return hn::MulAdd(hn::Sub(b, a), tz, a);
    };
    const V near0 = along_z(0), near1 = along_z(samples);
    const V far0 = along_z(samples * samples), far1 = along_z(samples * samples + samples);
    const V near = hn::MulAdd(hn::Sub(near1, near0), ty, near0);
    const V far = hn::MulAdd(hn::Sub(far1, far0), ty, far0);
    hn::StoreU(hn::MulAdd(hn::Sub(far, near), tx, near), d, distances);
}

void sample_all(const BrickView& view, const Points& points, float* distances) {
    const hn::CappedTag<float, 16> d;
    const std::size_t lanes = hn::Lanes(d);
    std::size_t i = 0;
    for (; i + lanes <= points.count; i += lanes)
        sample(d, view, points.x + i, points.y + i, points.z + i, distances + i);
    if (const std::size_t rest = points.count - i; rest > 0) {
        float x[16] = {}, y[16] = {}, z[16] = {}, out[16];
        std::copy_n(points.x + i, rest, x);
        std::copy_n(points.y + i, rest, y);
        std::copy_n(points.z + i, rest, z);
        sample(d, view, x, y, z, out);
        std::copy_n(out, rest, distances + i);
    }
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alcove {

HWY_EXPORT(sample_all);

void sample_bricks(const BrickView& view, const Points& points, float* distances) {
    HWY_DYNAMIC_DISPATCH(sample_all)(view, points, distances);
}

}
#endif
