#include "alcove/occlusion/detail/local_fit.h"

#include "alcove/occlusion/detail/directions.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alcove/occlusion/detail/local_fit.cpp"
#include <hwy/foreach_target.h> // compiles this file once per target
#include <hwy/highway.h>

#ifndef ALCOVE_OCCLUSION_DETAIL_LOCAL_FIT_ONCE
#define ALCOVE_OCCLUSION_DETAIL_LOCAL_FIT_ONCE
namespace alcove {

/// Weighted sums over the sources. a and b are coordinates on the tangent plane.
struct FitSums {
    float w, wa, wb, waa, wab, wbb;
    float wvv; ///< of the first value only
    SurfelValues wv, wva, wvb;
};

}
#endif

HWY_BEFORE_NAMESPACE();
namespace alcove {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <std::size_t used>
FitSums sum_terms(const FitSources::Arrays& sources, const Surfel& at, const Basis& basis, float reach) {
    const hn::CappedTag<float, FitSources::lanes> d;
    using V = hn::Vec<decltype(d)>;
    const auto dot = [&](V x, V y, V z, const Vec3& v) HWY_ATTR {
        return hn::MulAdd(x, hn::Set(d, v.x), hn::MulAdd(y, hn::Set(d, v.y), hn::Mul(z, hn::Set(d, v.z))));
    };
    const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f), flattening = hn::Set(d, 3.0f),
               inverse_reach2 = hn::Set(d, 1.0f / (reach * reach));
    auto w = zero, wa = zero, wb = zero, waa = zero, wab = zero, wbb = zero, wvv = zero;
    V wv[used], wva[used], wvb[used];
    for (std::size_t k = 0; k < used; ++k)
        wv[k] = wva[k] = wvb[k] = zero;
    for (std::size_t i = 0; i < sources.count; i += hn::Lanes(d)) {
        const auto x = hn::Sub(hn::LoadU(d, sources.position[0] + i), hn::Set(d, at.position.x)),
                   y = hn::Sub(hn::LoadU(d, sources.position[1] + i), hn::Set(d, at.position.y)),
                   z = hn::Sub(hn::LoadU(d, sources.position[2] + i), hn::Set(d, at.position.z));
        const auto a = dot(x, y, z, basis.tangent), b = dot(x, y, z, basis.bitangent), height = dot(x, y, z, at.normal);
        const auto distance2 = hn::MulAdd(a, a, hn::MulAdd(b, b, hn::Mul(flattening, hn::Mul(height, height))));
        const auto near = hn::Max(hn::NegMulAdd(distance2, inverse_reach2, one), zero);
        const auto cosine = hn::Max(dot(hn::LoadU(d, sources.normal[0] + i), hn::LoadU(d, sources.normal[1] + i),
                                        hn::LoadU(d, sources.normal[2] + i), at.normal),
                                    zero);
        const auto root = hn::Mul(near, hn::Mul(cosine, cosine)), weight = hn::Mul(root, root);
        const auto along_a = hn::Mul(weight, a), along_b = hn::Mul(weight, b);
        w = hn::Add(w, weight);
        wa = hn::Add(wa, along_a);
        wb = hn::Add(wb, along_b);
        waa = hn::MulAdd(along_a, a, waa);
        wab = hn::MulAdd(along_a, b, wab);
        wbb = hn::MulAdd(along_b, b, wbb);
        for (std::size_t k = 0; k < used; ++k) {
            const auto v = hn::LoadU(d, sources.values[k] + i), weighted = hn::Mul(weight, v);
            wv[k] = hn::Add(wv[k], weighted);
            wva[k] = hn::MulAdd(along_a, v, wva[k]);
            wvb[k] = hn::MulAdd(along_b, v, wvb[k]);
            if (k == 0)
                wvv = hn::MulAdd(weighted, v, wvv);
        }
    }
    const auto sum = [&](V lanes) HWY_ATTR { return hn::GetLane(hn::SumOfLanes(d, lanes)); };
    FitSums sums{sum(w), sum(wa), sum(wb), sum(waa), sum(wab), sum(wbb), sum(wvv), {}, {}, {}};
    for (std::size_t k = 0; k < used; ++k)
        sums.wv[k] = sum(wv[k]), sums.wva[k] = sum(wva[k]), sums.wvb[k] = sum(wvb[k]);
    return sums;
}

FitSums sum_terms_of_one(const FitSources::Arrays& sources, const Surfel& at, const Basis& basis, float reach) {
    return sum_terms<1>(sources, at, basis, reach);
}

FitSums sum_terms_of_four(const FitSources::Arrays& sources, const Surfel& at, const Basis& basis, float reach) {
    return sum_terms<4>(sources, at, basis, reach);
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alcove {

HWY_EXPORT(sum_terms_of_one);
HWY_EXPORT(sum_terms_of_four);

void FitSources::push_back(const Surfel& surfel, const SurfelValues& values) {
    if (count_ + lanes > columns_[0].size())
        for (std::vector<float>& column : columns_)
            column.resize(2 * column.size() + 2 * lanes);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        columns_[axis][count_] = surfel.position[static_cast<int>(axis)];
        columns_[3 + axis][count_] = surfel.normal[static_cast<int>(axis)];
    }
    for (std::size_t k = 0; k < values.size(); ++k)
        columns_[first_value + k][count_] = values[k];
    ++count_;
}

FitSources::Arrays FitSources::arrays() {
    const std::size_t padded = (count_ + lanes - 1) / lanes * lanes;
    for (std::vector<float>& column : columns_)
        std::fill(column.begin() + static_cast<std::ptrdiff_t>(count_),
                  column.begin() + static_cast<std::ptrdiff_t>(padded), 0.0f);
    const auto column = [&](std::size_t c) -> const float* { return columns_[c].data(); };
    return {{column(0), column(1), column(2)},
            {column(3), column(4), column(5)},
            {column(6), column(7), column(8), column(9)},
            padded};
}

LocalFit local_fit(const FitSources::Arrays& sources, const Surfel& at, float reach, std::size_t used) {
    const Basis basis(at.normal);
    const FitSums s = used == 1 ? HWY_DYNAMIC_DISPATCH(sum_terms_of_one)(sources, at, basis, reach)
                                : HWY_DYNAMIC_DISPATCH(sum_terms_of_four)(sources, at, basis, reach);
    if (!(s.w > 0.0f))
        return {};
    LocalFit fit{.weight = s.w};
    const float per_weight = 1.0f / s.w, a = per_weight * s.wa, b = per_weight * s.wb;
    // Without this term, few or collinear sources would leave the slope undetermined.
    const float stiffness = 0.002f * reach * reach;
    const float aa = per_weight * s.waa - a * a + stiffness, bb = per_weight * s.wbb - b * b + stiffness,
                ab = per_weight * s.wab - a * b, per_determinant = 1.0f / (aa * bb - ab * ab);
    for (std::size_t k = 0; k < used; ++k) {
        const float mean = per_weight * s.wv[k], av = per_weight * s.wva[k] - a * mean,
                    bv = per_weight * s.wvb[k] - b * mean;
        const float slope_a = per_determinant * (av * bb - bv * ab), slope_b = per_determinant * (bv * aa - av * ab);
        fit.values[k] = mean - slope_a * a - slope_b * b;
        if (k == 0)
            fit.deviation = std::sqrt(std::max(per_weight * s.wvv - mean * mean - slope_a * av - slope_b * bv, 0.0f));
    }
    return fit;
}

}
#endif
