#include "alcove/occlusion/detail/ring_network.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alcove/occlusion/detail/ring_network.cpp"
#include <hwy/foreach_target.h> // compiles this file once per target
#include <hwy/highway.h>

#ifndef ALCOVE_RING_NETWORK_MATRIX
#define ALCOVE_RING_NETWORK_MATRIX
namespace alcove {

/// A block of a matrix, row by row; `stride` is the distance between the starts of successive rows.
struct Matrix {
    const float* weights;
    std::size_t stride, rows, columns;
};

}
#endif

HWY_BEFORE_NAMESPACE();
namespace alcove {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// out[o] += Σ weights[o][i] in[i] for the lanes of a batch.
void add_product(const Matrix& matrix, const float* in, float* out) {
    constexpr std::size_t lanes = SurfelBatch::capacity, block = 4; // rows whose sums fit in registers
    const hn::CappedTag<float, 16> d;
    const std::size_t n = hn::Lanes(d);
    std::size_t o = 0;
    for (; o + block <= matrix.rows; o += block) {
        const float *const wa = matrix.weights + o * matrix.stride, *const wb = wa + matrix.stride,
                           *const wc = wb + matrix.stride, *const wd = wc + matrix.stride;
        for (std::size_t k = 0; k < lanes; k += 2 * n) {
            float *const a = out + o * lanes + k, *const b = a + lanes, *const c = b + lanes, *const e = c + lanes;
            auto a0 = hn::LoadU(d, a), a1 = hn::LoadU(d, a + n), b0 = hn::LoadU(d, b), b1 = hn::LoadU(d, b + n),
                 c0 = hn::LoadU(d, c), c1 = hn::LoadU(d, c + n), e0 = hn::LoadU(d, e), e1 = hn::LoadU(d, e + n);
            for (std::size_t i = 0; i < matrix.columns; ++i) {
                const auto x0 = hn::LoadU(d, in + i * lanes + k), x1 = hn::LoadU(d, in + i * lanes + k + n);
                a0 = hn::MulAdd(hn::Set(d, wa[i]), x0, a0), a1 = hn::MulAdd(hn::Set(d, wa[i]), x1, a1);
                b0 = hn::MulAdd(hn::Set(d, wb[i]), x0, b0), b1 = hn::MulAdd(hn::Set(d, wb[i]), x1, b1);
                c0 = hn::MulAdd(hn::Set(d, wc[i]), x0, c0), c1 = hn::MulAdd(hn::Set(d, wc[i]), x1, c1);
                e0 = hn::MulAdd(hn::Set(d, wd[i]), x0, e0), e1 = hn::MulAdd(hn::Set(d, wd[i]), x1, e1);
            }
            hn::StoreU(a0, d, a), hn::StoreU(a1, d, a + n), hn::StoreU(b0, d, b), hn::StoreU(b1, d, b + n);
            hn::StoreU(c0, d, c), hn::StoreU(c1, d, c + n), hn::StoreU(e0, d, e), hn::StoreU(e1, d, e + n);
        }
    }
    for (; o < matrix.rows; ++o)
        for (std::size_t k = 0; k < lanes; k += n) {
            auto sum = hn::LoadU(d, out + o * lanes + k);
            for (std::size_t i = 0; i < matrix.columns; ++i)
                sum = hn::MulAdd(hn::Set(d, matrix.weights[o * matrix.stride + i]), hn::LoadU(d, in + i * lanes + k),
                                 sum);
            hn::StoreU(sum, d, out + o * lanes + k);
        }
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alcove {
namespace {

using Values = SurfelBatch::Values;

constexpr std::size_t most_units = 32; // of a layer

void rectify(std::span<Values> all) {
    for (Values& values : all)
        for (float& value : values)
            value = std::max(value, 0.0f);
}

void fill(std::span<Values> all, const float* bias) {
    for (std::size_t i = 0; i < all.size(); ++i)
        all[i].fill(bias[i]);
}

}

HWY_EXPORT(add_product);

std::size_t RingNetwork::size(const Shape& s) {
    const std::size_t whole = s.shared + 2;
    return s.first * (2 * s.features + whole + 1) + s.second * (s.first + 1) + hidden * (s.second + whole + 1) + hidden;
}

RingNetwork::RingNetwork(const Shape& shape, std::vector<float> coefficients)
    : shape_(shape), coefficients_(std::move(coefficients)) {
    if (coefficients_.size() != size(shape) || std::max({shape.features, shape.first, shape.second}) > most_units)
        throw std::logic_error("the coefficients do not fit the network");
    const std::size_t whole = shape.shared + 2;
    const float* at = coefficients_.data();
    const auto next = [&](std::size_t count) {
        const float* const begin = at;
        at += count;
        return begin;
    };
    own_ = next(shape.first * shape.features);
    neighbours_ = next(shape.first * shape.features);
    shared_ = next(shape.first * whole);
    first_bias_ = next(shape.first);
    second_ = next(shape.second * shape.first);
    second_bias_ = next(shape.second);
    third_ = next(hidden * (shape.second + whole));
    third_bias_ = next(hidden);
    std::copy_n(next(hidden), hidden, last_.begin());
}

void RingNetwork::hidden_layer(std::span<const Values> inputs, const Condition& condition, Hidden& h) const {
    const std::size_t normals = shape_.shared, azimuths = shape_.azimuths, per_azimuth = shape_.features,
                      first = shape_.first, second = shape_.second;
    const std::size_t whole = normals + 2; // columns of inputs that concern the whole surfel
    std::array<Values, 2> given;
    std::array<Values, most_units> common, e, f, mean, middle;
    given[0].fill(condition.resolution);
    given[1].fill(condition.two_sided);
    const auto add = [](const Matrix& matrix, const Values& in, Values& out) {
        HWY_DYNAMIC_DISPATCH(add_product)(matrix, in.data(), out.data());
    };
    fill(std::span(common).first(first), first_bias_);
    add({shared_, whole, first, normals}, inputs[0], common[0]);
    add({shared_ + normals, whole, first, 2}, given[0], common[0]);
    for (Values& sum : std::span(mean).first(second))
        sum.fill(0.0f);
    for (std::size_t a = 0; a < azimuths; ++a) {
        const auto at = [&](std::size_t azimuth) { return &inputs[normals + azimuth % azimuths * per_azimuth]; };
        const Values *const before = at(a + azimuths - 1), *const after = at(a + 1);
        for (std::size_t i = 0; i < per_azimuth; ++i)
            for (std::size_t k = 0; k < SurfelBatch::capacity; ++k)
                middle[i][k] = 0.5f * (before[i][k] + after[i][k]);
        std::copy_n(common.begin(), first, e.begin());
        add({own_, per_azimuth, first, per_azimuth}, *at(a), e[0]);
        add({neighbours_, per_azimuth, first, per_azimuth}, middle[0], e[0]);
        rectify(std::span(e).first(first));
        fill(std::span(f).first(second), second_bias_);
        add({second_, first, second, first}, e[0], f[0]);
        rectify(std::span(f).first(second));
        for (std::size_t i = 0; i < second; ++i)
            for (std::size_t k = 0; k < SurfelBatch::capacity; ++k)
                mean[i][k] += f[i][k] / static_cast<float>(azimuths);
    }
    fill(h, third_bias_);
    add({third_, second + whole, hidden, second}, mean[0], h[0]);
    add({third_ + second, second + whole, hidden, normals}, inputs[0], h[0]);
    add({third_ + second + normals, second + whole, hidden, 2}, given[0], h[0]);
    rectify(h);
    const std::array<float, hidden> plane = hidden_on_plane(condition);
    for (std::size_t o = 0; o < hidden; ++o)
        for (float& value : h[o])
            value -= plane[o];
}

void RingNetwork::value(const Hidden& h, const LastLayer& last, Values& values) {
    values.fill(0.0f);
    for (std::size_t o = 0; o < hidden; ++o)
        for (std::size_t k = 0; k < SurfelBatch::capacity; ++k)
            values[k] += last[o] * h[o][k];
}

/// h for n = 0 and r_a = 0, for which all azimuths give the same f_a.
std::array<float, RingNetwork::hidden> RingNetwork::hidden_on_plane(const Condition& condition) const {
    const std::size_t normals = shape_.shared, first = shape_.first, second = shape_.second, whole = normals + 2;
    const auto of_condition = [&](const float* row) {
        return row[normals] * condition.resolution + row[normals + 1] * condition.two_sided;
    };
    std::array<float, most_units> e, f;
    for (std::size_t o = 0; o < first; ++o)
        e[o] = std::max(first_bias_[o] + of_condition(shared_ + o * whole), 0.0f);
    for (std::size_t o = 0; o < second; ++o)
        f[o] = std::max(std::inner_product(e.begin(), e.begin() + first, second_ + o * first, second_bias_[o]), 0.0f);
    std::array<float, hidden> h;
    for (std::size_t o = 0; o < hidden; ++o) {
        const float* const row = third_ + o * (second + whole);
        h[o] = std::max(
            std::inner_product(f.begin(), f.begin() + second, row, third_bias_[o]) + of_condition(row + second), 0.0f);
    }
    return h;
}

}
#endif
