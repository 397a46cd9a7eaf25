#include "alcove/occlusion/detail/bilateral_sums.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alcove/occlusion/detail/bilateral_sums.cpp"
#include <hwy/foreach_target.h> // compiles this file once per target
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace alcove {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
static_assert(Curve::window % 16 == 0);

void weigh_all(const Curve& curve, std::size_t center, std::size_t first, float reach, float* weights) {
    const D d;
    const auto one = hn::Set(d, 1.0f), zero = hn::Zero(d);
    const auto at_center = [&](const float* values) HWY_ATTR { return hn::Set(d, values[center]); };
    const auto x = at_center(curve.x), y = at_center(curve.y), z = at_center(curve.z);
    const auto nx = at_center(curve.nx), ny = at_center(curve.ny), nz = at_center(curve.nz);
    const auto inverse_reach2 = hn::Set(d, 1.0f / (reach * reach)), sharpness = hn::Set(d, 0.4f);
    for (std::size_t k = 0; k < Curve::window; k += hn::Lanes(d)) {
        const std::size_t i = first + k;
        const auto dx = hn::Sub(hn::LoadU(d, curve.x + i), x), dy = hn::Sub(hn::LoadU(d, curve.y + i), y),
                   dz = hn::Sub(hn::LoadU(d, curve.z + i), z);
        const auto distance2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
        const auto near = hn::Max(hn::NegMulAdd(distance2, inverse_reach2, one), zero);
        const auto cosine =
            hn::Max(hn::MulAdd(hn::LoadU(d, curve.nx + i), nx,
                               hn::MulAdd(hn::LoadU(d, curve.ny + i), ny, hn::Mul(hn::LoadU(d, curve.nz + i), nz))),
                    zero);
        auto difference2 = zero;
        for (const float* probe : curve.probe) {
            const auto difference = hn::Sub(hn::LoadU(d, probe + i), hn::Set(d, probe[center]));
            difference2 = hn::MulAdd(difference, difference, difference2);
        }
        const auto similar = hn::Max(hn::NegMulAdd(difference2, sharpness, one), zero);
        const auto root = hn::Mul(hn::Mul(near, similar), hn::Mul(cosine, cosine));
        hn::StoreU(hn::Mul(root, root), d, weights + k);
    }
}

Moments sum_moments(const float* weights, const float* guide, float origin, const float* values) {
    const D d;
    const auto zero = hn::Zero(d), center = hn::Set(d, origin);
    auto w = zero, g = zero, gg = zero, v = zero, vg = zero, vv = zero;
    for (std::size_t k = 0; k < Curve::window; k += hn::Lanes(d)) {
        const auto weight = hn::LoadU(d, weights + k), value = hn::LoadU(d, values + k);
        const auto relative = hn::Sub(hn::LoadU(d, guide + k), center);
        const auto weighted_g = hn::Mul(weight, relative), weighted_v = hn::Mul(weight, value);
        w = hn::Add(w, weight);
        g = hn::Add(g, weighted_g);
        gg = hn::MulAdd(weighted_g, relative, gg);
        v = hn::Add(v, weighted_v);
        vg = hn::MulAdd(weighted_v, relative, vg);
        vv = hn::MulAdd(weighted_v, value, vv);
    }
    const auto sum = [&](auto lanes) HWY_ATTR { return hn::GetLane(hn::SumOfLanes(d, lanes)); };
    return {sum(w), sum(g), sum(gg), sum(v), sum(vg), sum(vv)};
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alcove {

HWY_EXPORT(weigh_all);
HWY_EXPORT(sum_moments);

void weigh(const Curve& curve, std::size_t center, std::size_t first, float reach, float* weights) {
    HWY_DYNAMIC_DISPATCH(weigh_all)(curve, center, first, reach, weights);
}

Moments moments(const float* weights, const float* guide, float origin, const float* values) {
    return HWY_DYNAMIC_DISPATCH(sum_moments)(weights, guide, origin, values);
}

}
#endif
