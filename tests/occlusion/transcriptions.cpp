#include "transcriptions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alcove::test {
namespace {

constexpr double pi = std::numbers::pi;

double fract(double x) {
    return x - std::floor(x);
}

double hash(double x) {
    return fract(std::sin(x) * 43758.5453);
}

double clamp(double x) {
    return std::clamp(x, 0.0, 1.0);
}

/// Listing 3 of (Duff et al. 2017).
Vec3d around(const Vec3d& n, const Vec3d& local) {
    const double sign = std::copysign(1.0, n.z), a = -1.0 / (sign + n.z), b = n.x * n.y * a;
    const Vec3d b1(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), b2(b, sign + n.y * n.y * a, -n.y);
    return local.x * b1 + local.y * b2 + local.z * n;
}

Vec3d flipped(const Vec3d& direction, const Vec3d& n, Axes axes) {
    if (axes == Axes::surfel)
        return around(n, {direction.x, direction.y, std::abs(direction.z)});
    return glm::dot(direction, n) < 0.0 ? -direction : direction;
}

}

double classic(const Distance& d, const Vec3d& p, const Vec3d& n) {
    double sum = 0.0, weight = 1.0;
    for (int i = 0; i < 5; ++i) {
        const double h = 0.01 + 0.12 * i / 4.0;
        sum += (h - d(p + h * n)) * weight;
        weight *= 0.95;
        if (sum > 0.35)
            break;
    }
    return clamp(1.0 - 3.0 * sum);
}

double convexity(const Distance& d, const Vec3d& p, const Vec3d& n) {
    const double outside = 1.0 - classic(d, p, n);
    const double inside = 1.0 - classic([&](const Vec3d& x) { return std::abs(d(x)); }, p, -n);
    return clamp(0.5 + 0.5 * (inside - outside));
}

double exponential(const Distance& d, const Vec3d& p, const Vec3d& n, double factor) {
    const double s = 5.0;
    double sum = 0.0;
    for (int i = 1; i / s < 1.0; ++i) {
        const double h = i / s;
        sum += std::pow(2.0, -h * s) * (h - d(p + h * n));
    }
    return clamp(factor * (1.0 - sum));
}

double decay(const Distance& d, const Vec3d& p, const Vec3d& n, double step) {
    double found = 0.0, whole = 0.0;
    for (int i = 0; i < 5; ++i) {
        const double h = (i + 1) * step;
        found += std::pow(2.0, -i) * d(p + h * n);
        whole += std::pow(2.0, -i) * h;
    }
    return clamp(found / whole);
}

double decay_linear(const Distance& d, const Vec3d& p, const Vec3d& n, double step) {
    double found = 0.0, whole = 0.0;
    for (int i = 0; i < 5; ++i) {
        const double h = (i + 1) * step;
        found += d(p + h * n);
        whole += h;
    }
    return clamp(found / whole);
}

double multiplicative(const Distance& d, const Vec3d& p, const Vec3d& n) {
    double ao = 1.0;
    for (int i = 0; i < 6; ++i) {
        const double h = 0.1 * (i + 1);
        ao *= 1.0 - std::max(0.0, (h - d(p + h * n)) * 0.2 / h);
    }
    return ao;
}

double multiscale_short(const Distance& d, const Vec3d& p, const Vec3d& n) {
    double product = 1.0;
    for (int j = 0; j <= 3; ++j) {
        const double h = 0.1 * std::pow(2.0, j);
        product *= clamp(d(p + h * n) / h);
    }
    return product;
}

double multiscale_long(const Distance& d, const Vec3d& p, const Vec3d& n) {
    double product = multiscale_short(d, p, n);
    for (int j = 4; j <= 6; ++j) {
        const double h = 0.1 * std::pow(2.0, j);
        product *= clamp(d(p + h * n) / h);
    }
    return product;
}

double multiscale(const Distance& d, const Vec3d& p, const Vec3d& n) {
    return std::max(0.035, std::pow(multiscale_long(d, p, n), 0.3));
}

double jittered(const Distance& d, const Vec3d& p, const Vec3d& n) {
    const double count = 6.0, max_distance = 4.0;
    double sum = 0.0;
    for (int i = 1; i <= 6; ++i) {
        const double l = (i + hash(i)) * 0.5 / count * max_distance;
        sum += (l - d(p + l * n)) / (1.0 + l);
    }
    return clamp(1.0 - sum / count);
}

double jittered_falloff(const Distance& d, const Vec3d& p, const Vec3d& n, double falloff) {
    const double max_distance = 1.0;
    double sum = 0.0;
    for (int i = 0; i <= 5; ++i) {
        const double l = hash(i) * max_distance;
        sum += (l - std::max(d(p + l * n), 0.0)) / max_distance * falloff;
    }
    return clamp(1.0 - sum / 6.0);
}

double hemisphere_random(const Distance& d, const Vec3d& p, const Vec3d& n, Axes axes, double seed) {
    double sum = 0.0;
    for (int i = 0; i < 32; ++i) {
        const double h = 0.01 + 4.0 * std::pow(i / 31.0, 2.0), x = seed + 13.1 * i;
        const double theta = fract(std::sin(x) * 43758.5453) * 3.14159;
        const double phi = fract(std::sin(x + 1.0) * 22578.1459) * 6.2831;
        const Vec3d direction(std::sin(theta) * std::sin(phi), std::sin(theta) * std::cos(phi), std::cos(theta));
        sum += std::clamp(5.0 * d(p + h * flipped(direction, n, axes)) / h, -1.0, 1.0);
    }
    return clamp(sum / 32.0);
}

double hemisphere(const Distance& d, const Vec3d& p, const Vec3d& n, Axes axes, int count) {
    const double max_distance = 1.0, falloff = 1.0, rad = 1.0 - 1.0 / count;
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
        const double l = hash(i) * max_distance;
        const double s = 2.0 * pi * hash(l + 1.0), t = 2.0 * hash(l + 2.0) - 1.0;
        const Vec3d v = Vec3d(std::cos(s), std::sin(s), t) / std::sqrt(1.0 + t * t);
        const Vec3d direction = glm::normalize(n + flipped(v, n, axes) * rad);
        sum += (l - std::max(d(p + l * direction), 0.0)) / max_distance * falloff;
    }
    return clamp(1.0 - sum / count);
}

double fibonacci(const Distance& d, const Vec3d& p, const Vec3d& n, Axes axes) {
    double sum = 0.0;
    for (int i = 0; i < 32; ++i) {
        const double phi = 2.0 * pi * fract(i / 1.618033988749895), z = 1.0 - (2.0 * i + 1.0) / 32.0;
        const double across = std::sin(std::acos(z));
        const Vec3d direction(std::cos(phi) * across, std::sin(phi) * across, z);
        sum += clamp(3.0 * d(p + 0.01 * n + hash(i) * 0.1 * flipped(direction, n, axes)));
    }
    return clamp(6.0 * (1.0 / 32.0) * sum);
}

}
