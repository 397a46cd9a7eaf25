/// From geometry, occlusion and light to colour: pure functions, linear light.
///
/// Source of all but srgb_encoded(): "SDF Ambient Occlusion — Detailed Reference" (2026), its ways to use occlusion in
/// light. n is the normal, u = n·up, v the direction toward the eye; all vectors are of unit length.
#pragma once

#include "alcove/base/types.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace alcove {

/// Which light occlusion takes from.
enum class OcclusionUse {
    ambient,    ///< diffuse·shadow + ambient·ao
    everything, ///< (diffuse·shadow + ambient)·ao
    sky,        ///< diffuse·shadow + ambient·ao·(½ + ½ u)
};

/// One key light, the sky, and what the ground throws back. All vectors in scene directions, unit length.
struct Lighting {
    Vec3 up{0.0f, 1.0f, 0.0f}; ///< where the sky is
    Vec3 toward_key{0.0f, 1.0f, 0.0f};
    Vec3 key{0.48f, 0.45f, 0.40f};    ///< a surface that faces the key
    Vec3 sky{0.48f, 0.51f, 0.56f};    ///< an open surface that faces up: the ambient light
    Vec3 ground{0.20f, 0.18f, 0.16f}; ///< an open surface that faces down
    OcclusionUse use = OcclusionUse::sky;
};

/// What a surface makes of light.
struct Material {
    Vec3 color{0.8f};                 ///< share of the light that it gives back, in [0, 1]
    std::optional<Vec3> edge_color{}; ///< of convex edges
    Vec3 subsurface{0.0f};            ///< light that comes from within where nothing occludes
    float reflection = 0.0f;          ///< of the sky at grazing angles, in [0, 1]
    float occlusion = 1.0f;           ///< multiplies the computed ao, in [0, 1]
};

/// What is known of a place of the surface.
struct Place {
    Vec3 normal{0.0f, 1.0f, 0.0f};
    Vec3 to_eye{0.0f, 1.0f, 0.0f};
    float ao = 1.0f, shadow = 1.0f; ///< shares of light that arrive
    float convexity = 0.5f;
    float painted = 1.0f; ///< multiplies ao, as the material's occlusion does
};

/// The share of the sky above a surface that nothing covers: ½ + ½ u.
inline float sky_visibility(float upward) {
    return 0.5f + 0.5f * upward;
}

/// The share of the ground's light: clamp(−u) ao.
inline float bounce(float upward, float ao) {
    return std::clamp(-upward, 0.0f, 1.0f) * ao;
}

/// The share of the light from within: 0.05 + 0.95 ao.
inline float subsurface(float ao) {
    return 0.05f + 0.95f * ao;
}

/// The share of the environment that is mirrored: (1 − max(0, v·n))⁵ ao. The document has v from the eye, which turns the
/// sign.
inline float fresnel(const Vec3& normal, const Vec3& to_eye, float ao) {
    const float grazing = 1.0f - std::max(0.0f, glm::dot(normal, to_eye));
    return grazing * grazing * grazing * grazing * grazing * ao;
}

/// The share of the edge colour: convexity above flat, from 0 to 1.
inline float edge_share(float convexity) {
    return std::clamp(2.0f * convexity - 1.0f, 0.0f, 1.0f);
}

/// All of these together.
inline Vec3 shade(const Lighting& lighting, const Material& material, const Place& place) {
    const float ao = place.ao * material.occlusion * place.painted;
    const float upward = glm::dot(place.normal, lighting.up);
    const Vec3 direct =
        std::max(0.0f, glm::dot(place.normal, lighting.toward_key)) * place.shadow * lighting.key;
    Vec3 light(0.0f);
    switch (lighting.use) {
    case OcclusionUse::ambient:
        light = direct + ao * lighting.sky;
        break;
    case OcclusionUse::everything:
        light = ao * (direct + lighting.sky);
        break;
    case OcclusionUse::sky:
        light = direct + ao * sky_visibility(upward) * lighting.sky;
        break;
    }
    light += bounce(upward, ao) * lighting.ground;
    const Vec3 color = material.edge_color
                           ? glm::mix(material.color, *material.edge_color, edge_share(place.convexity))
                           : material.color;
    return color * light + subsurface(ao) * material.subsurface +
           material.reflection * fresnel(place.normal, place.to_eye, ao) * lighting.sky;
}

/// Linear light in [0, 1] to the sRGB curve; values outside are clamped. IEC 61966-2-1 (1999).
inline float srgb_encoded(float linear) {
    const float x = std::clamp(linear, 0.0f, 1.0f);
    return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
}

}
