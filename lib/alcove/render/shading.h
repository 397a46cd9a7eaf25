/// From geometry and occlusion to colour: pure functions, linear light.
#pragma once

#include "alcove/types.h"

#include <algorithm>
#include <cmath>

namespace alcove {

/// One key light, the sky, and what the ground throws back. All vectors in scene directions, unit length.
struct Lighting {
    Vec3 up{0.0f, 1.0f, 0.0f}; ///< where the sky is
    Vec3 toward_key{0.0f, 1.0f, 0.0f};
    Vec3 key{0.25f, 0.23f, 0.20f};    ///< a surface that faces the key
    Vec3 sky{0.72f, 0.74f, 0.77f};    ///< an open surface that faces up
    Vec3 ground{0.20f, 0.18f, 0.16f}; ///< an open surface that faces down
};

/// The share of the sky above a surface that nothing covers: 1 facing up, 0 facing down.
inline float sky_visibility(float upward) {
    return 0.5f + 0.5f * upward;
}

/// Occlusion takes from ambient light only:
///
///     max(0, n·l) key + ao ((½ + ½ n·up) sky + max(0, −n·up) ground)
///
/// Source: "SDF Ambient Occlusion — Detailed Reference" (2026): ambient·ao with sky visibility, and its
/// bounce term.
inline Vec3 shade(const Lighting& lighting, const Vec3& normal, float ao) {
    const float upward = glm::dot(normal, lighting.up);
    return std::max(0.0f, glm::dot(normal, lighting.toward_key)) * lighting.key +
           ao * (sky_visibility(upward) * lighting.sky + std::max(0.0f, -upward) * lighting.ground);
}

/// Linear light in [0, 1] to the sRGB curve; values outside are clamped. IEC 61966-2-1 (1999).
inline float srgb_encoded(float linear) {
    const float x = std::clamp(linear, 0.0f, 1.0f);
    return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
}

}
