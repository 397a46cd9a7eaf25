/// The pseudo-random numbers of the reference formulas. They are computed in double precision, because single precision
/// gives different numbers on different machines.
#pragma once

#include <array>
#include <cmath>

namespace alcove {

/// fract(sin(x) · scale), in [0, 1). Source: sdfao2026.
inline double reference_hash(double x, double scale = 43758.5453) {
    const double y = std::sin(x) * scale;
    return y - std::floor(y);
}

inline std::array<double, 2> reference_hash2(double x) {
    return {reference_hash(x), reference_hash(x + 1.0, 22578.1459)};
}

}
