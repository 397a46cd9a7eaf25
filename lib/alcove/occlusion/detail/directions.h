/// Low-discrepancy, reproducible directions over the hemisphere around a normal.
#pragma once

#include "alcove/base/types.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace alcove {

/// An orthonormal basis around the unit vector n, continuous except where n.z changes sign (Duff et al. 2017).
struct Basis {
    Vec3 tangent, bitangent, normal;

    explicit Basis(const Vec3& n) : normal(n) {
        const float sign = std::copysign(1.0f, n.z);
        const float a = -1.0f / (sign + n.z), b = n.x * n.y * a;
        tangent = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
        bitangent = {b, sign + n.y * n.y * a, -n.y};
    }
    Vec3 to_world(const Vec3& local) const { return local.x * tangent + local.y * bitangent + local.z * normal; }
};

/// Cosine-weighted hemisphere sampling around +z, pdf cos θ / π; u, v in [0, 1). Malley's method in polar
/// coordinates (Malley 1988).
inline Vec3 cosine_hemisphere(float u, float v) {
    const float r = std::sqrt(u), phi = 2.0f * std::numbers::pi_v<float> * v;
    return {r * std::cos(phi), r * std::sin(phi), std::sqrt(1.0f - u)};
}

/// Uniform hemisphere sampling around +z, pdf 1 / 2π; u, v in [0, 1).
inline Vec3 uniform_hemisphere(float u, float v) {
    const float r = std::sqrt(1.0f - u * u), phi = 2.0f * std::numbers::pi_v<float> * v;
    return {r * std::cos(phi), r * std::sin(phi), u};
}

/// An integer hash: every output bit depends on every input bit. lowbias32 (Wellons 2018).
inline std::uint32_t hash(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

/// A number in [0, 1) from the upper 24 bits.
inline float unit_interval(std::uint32_t x) {
    return static_cast<float>(x >> 8) * 0x1p-24f;
}

/// Hash of a position and a seed: independent of the order of the vertices.
inline std::uint32_t hash(const Vec3& p, std::uint32_t seed) {
    std::uint32_t h = hash(seed + 0x9e3779b9u);
    for (const float coordinate : {p.x, p.y, p.z})
        h = hash(h ^ std::bit_cast<std::uint32_t>(coordinate + 0.0f));
    return h;
}

/// Point i of n of a Fibonacci lattice on the unit square (Keinert et al. 2015), shifted on the torus by
/// (shift_u, shift_v) (Cranley and Patterson 1976).
inline Vec2 fibonacci_point(int i, int n, float shift_u, float shift_v) {
    constexpr double golden = 0.6180339887498949;
    const double u = (i + 0.5) / n + shift_u, v = i * golden + shift_v;
    // Rounding to float must not give 1.
    constexpr float below_one = 1.0f - 0x1p-24f;
    return {std::min(static_cast<float>(u - std::floor(u)), below_one),
            std::min(static_cast<float>(v - std::floor(v)), below_one)};
}

/// Point i of an additive recurrence on the unit square: any run of consecutive points is low-discrepancy
/// (Roberts 2018).
inline Vec2 recurrence_point(std::uint64_t i, std::uint32_t seed) {
    // 1/ρ and 1/ρ² with ρ³ = ρ + 1, as fractions of 2^64: integer overflow takes the products modulo 1.
    const std::uint64_t u = i * 0xc13fa9a902a6328fu, v = i * 0x91e10da5c79e7b1du;
    const std::uint32_t h = hash(seed);
    return {unit_interval(static_cast<std::uint32_t>(u >> 32) + h),
            unit_interval(static_cast<std::uint32_t>(v >> 32) + hash(h))};
}

/// The lattice of fibonacci_point() mapped by cosine_hemisphere(). Its sines and cosines are computed once for
/// all shifts, because a shift in v is a rotation.
class CosineLattice {
  public:
    explicit CosineLattice(int count) : points_(static_cast<std::size_t>(count)) {
        for (int i = 0; i < count; ++i) {
            const Vec2 uv = fibonacci_point(i, count, 0.0f, 0.0f);
            const float phi = 2.0f * std::numbers::pi_v<float> * uv.y;
            points_[static_cast<std::size_t>(i)] = {uv.x, std::cos(phi), std::sin(phi)};
        }
    }

    /// The shift of one surfel's lattice on the torus.
    struct Shift {
        float u, cosine, sine;

        explicit Shift(std::uint32_t random) : Shift(Vec2(unit_interval(random), unit_interval(hash(random)))) {}
        explicit Shift(const Vec2& shift) : u(shift.x) {
            const float phi = 2.0f * std::numbers::pi_v<float> * shift.y;
            cosine = std::cos(phi), sine = std::sin(phi);
        }
    };

    Vec3 direction(int i, const Shift& shift) const {
        const Point& point = points_[static_cast<std::size_t>(i)];
        const float sum = point.u + shift.u, u = sum < 1.0f ? sum : sum - 1.0f, r = std::sqrt(u);
        return {r * (point.cosine * shift.cosine - point.sine * shift.sine),
                r * (point.cosine * shift.sine + point.sine * shift.cosine), std::sqrt(1.0f - u)};
    }

  private:
    struct Point {
        float u, cosine, sine;
    };
    std::vector<Point> points_;
};

}
