/// The transfer function of sRGB (IEC 61966-2-1, 1999).
#pragma once

#include "alcove/base/types.h"

#include <algorithm>
#include <cmath>

namespace alcove {

inline double encode_srgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

inline double decode_srgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// Encodes a linear colour as sRGB bytes. Components outside [0, 1] are clamped; NaN becomes 0.
inline Color srgb_color(const Vec3& linear, float alpha = 1.0f) {
    const auto byte = [](double value) {
        return static_cast<std::uint8_t>(std::lround(255.0 * (value > 0.0 ? std::min(value, 1.0) : 0.0)));
    };
    return {byte(encode_srgb(linear.r)), byte(encode_srgb(linear.g)), byte(encode_srgb(linear.b)), byte(alpha)};
}

}
