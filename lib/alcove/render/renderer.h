/// Renders a field with sphere-traced camera rays, shaded with ambient occlusion.
///
/// Every sample that hits the surface becomes a surfel, and the estimators evaluate these surfels as they do the
/// vertices of a mesh. The result does not depend on the number of threads.
#pragma once

#include "alcove/base/types.h"
#include "alcove/field/field.h"
#include "alcove/field/primitives.h"
#include "alcove/occlusion/catalog.h"
#include "alcove/occlusion/occluders.h"
#include "alcove/render/camera.h"
#include "alcove/render/image.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace alcove {

// Shading: pure functions in linear light. Source of all but srgb_encoded(): the lighting formulas of sdfao2026. n is
// the normal, u = n·up, v the direction toward the eye; all vectors have unit length.

/// Which light occlusion attenuates.
enum class OcclusionUse {
    ambient,    ///< diffuse·shadow + ambient·ao
    everything, ///< (diffuse·shadow + ambient)·ao
    sky,        ///< diffuse·shadow + ambient·ao·(½ + ½ u)
};

/// A key light, the sky, and light reflected by the ground. Directions are scene directions of unit length; each colour
/// is the light that arrives at the surface described beside it.
struct Lighting {
    Vec3 up{0.0f, 1.0f, 0.0f};         ///< toward the sky
    Vec3 toward_key{0.0f, 1.0f, 0.0f}; ///< toward the key light
    Vec3 key{0.48f, 0.45f, 0.40f};     ///< on a surface that faces the key light
    Vec3 sky{0.48f, 0.51f, 0.56f};     ///< on an open surface that faces up: the ambient light
    Vec3 ground{0.20f, 0.18f, 0.16f};  ///< on an open surface that faces down
    OcclusionUse use = OcclusionUse::sky;
};

struct Material {
    Vec3 color{0.8f};                 ///< diffuse reflectance, in [0, 1]
    std::optional<Vec3> edge_color{}; ///< diffuse reflectance of convex edges
    Vec3 subsurface{0.0f};            ///< subsurface light of an unoccluded point
    float reflection = 0.0f;          ///< reflectance of the sky at grazing angles, in [0, 1]
    float occlusion = 1.0f;           ///< multiplies the computed ao, in [0, 1]
};

/// The inputs of shading at a point of the surface.
struct Place {
    Vec3 normal{0.0f, 1.0f, 0.0f};
    Vec3 to_eye{0.0f, 1.0f, 0.0f};
    float ao = 1.0f, shadow = 1.0f; ///< shares of the light that arrive
    float convexity = 0.5f;
    float painted = 1.0f;        ///< multiplies ao, as the material's occlusion does
    std::optional<Vec3> color{}; ///< diffuse reflectance; replaces the colour of the material
};

/// The share of the sky that an unoccluded surface sees: ½ + ½ u.
inline float sky_visibility(float upward) {
    return 0.5f + 0.5f * upward;
}

/// The share of the light from the ground that arrives: clamp(−u) ao.
inline float bounce(float upward, float ao) {
    return std::clamp(-upward, 0.0f, 1.0f) * ao;
}

/// The share of the subsurface light that remains: 0.05 + 0.95 ao.
inline float subsurface(float ao) {
    return 0.05f + 0.95f * ao;
}

/// The share of the environment that is reflected: (1 − max(0, v·n))⁵ ao. In the reference v points away from the
/// eye, which flips the sign.
inline float fresnel(const Vec3& normal, const Vec3& to_eye, float ao) {
    const float grazing = 1.0f - std::max(0.0f, glm::dot(normal, to_eye));
    return grazing * grazing * grazing * grazing * grazing * ao;
}

/// The share of the edge colour: 0 on flat and concave surfaces, rising to 1 at convexity 1.
inline float edge_share(float convexity) {
    return std::clamp(2.0f * convexity - 1.0f, 0.0f, 1.0f);
}

/// The shaded colour: combines all the terms above.
inline Vec3 shade(const Lighting& lighting, const Material& material, const Place& place) {
    const float ao = place.ao * material.occlusion * place.painted;
    const float upward = glm::dot(place.normal, lighting.up);
    const Vec3 direct = std::max(0.0f, glm::dot(place.normal, lighting.toward_key)) * place.shadow * lighting.key;
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
    Vec3 color = place.color.value_or(material.color);
    if (material.edge_color)
        color = glm::mix(color, *material.edge_color, edge_share(place.convexity));
    return color * light + subsurface(ao) * material.subsurface +
           material.reflection * fresnel(place.normal, place.to_eye, ao) * lighting.sky;
}

/// Applies the sRGB transfer function to linear light, clamped to [0, 1] (srgb1999).
inline float srgb_encoded(float linear) {
    const float x = std::clamp(linear, 0.0f, 1.0f);
    return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
}

/// The share of sunlight that arrives at a point p. A ray marches along t toward the sun l; d is the field:
///
///     min(1, min over t of sharpness·d(p + t l)/t), 0 if the ray hits the surface
///
/// Source: sdfao2026, which marches t from 0.02 to 20 in a scene with a diagonal of 5.73. Lengths in unit space. A grid
/// carries no information within two voxels of the surface, so rays start at least that far away.
struct SoftShadow {
    float sharpness = 8.0f; ///< > 0; larger values give harder edges
    float begin = 0.02f / 5.73f;
    float end = 20.0f / 5.73f;
};

/// One share of sunlight per surfel, in [0, 1]: 0 for surfels that face away from the sun, 1 for surfels without a
/// normal. `toward_sun` has unit length. Thread-safe. Cost: 5–30 map() calls per surfel that faces the sun.
std::vector<float> soft_shadows(std::span<const Surfel> surfels, const AnyField& field, const Vec3& toward_sun,
                                const SoftShadow& shadow = {});

// The geometry and materials that a camera renders.

/// The object that a sample shows: 0 for the background, then the parts counted from 1, then the grounds.
using ObjectId = std::uint16_t;
inline constexpr ObjectId no_object = 0;

struct Texture; // texels by UV (render/detail/texture.h)

/// A mesh to render. Each vector has one value per position of the surface.
struct RenderableMesh {
    RaySurface surface;            ///< unit space
    std::vector<ObjectId> objects; ///< part number
    std::vector<Vec3> normals;     ///< of any length; zero keeps the normal of the field
    std::vector<Vec3> colors;      ///< linear light; may be empty
    std::vector<Vec2> uvs{};       ///< NaN: not textured; empty without a texture
    std::shared_ptr<const Texture> texture{};
};

/// One operand of the union that forms a field.
struct Part {
    AnyField field; ///< unit space
    Material material{};
    bool colored = false;      ///< the colours of the mesh replace the colour of the material
    bool painted = false;      ///< the brightness of the colours of the mesh multiplies ao
    bool on_triangles = false; ///< the triangles are the only surface: where only the field is met, nothing is shown
};

/// A plane, visible from its front only, that fades into the background.
struct Ground {
    Plane plane; ///< unit space
    /// Distances from the origin, unit space: fully opaque up to `whole`, invisible beyond `gone`.
    float whole = 50.0f, gone = 100.0f;
    Material material{};

    /// Opacity at the point p of the plane, in [0, 1].
    float coverage(const Vec3& p) const;
};

struct Renderable {
    AnyField field;            ///< everything except the grounds, unit space
    Frame frame;               ///< maps unit space to scene space
    Box box;                   ///< scene units; the field is not rendered outside it
    std::vector<Part> parts{}; ///< `field` is their union; if empty, `field` is a single part
    std::vector<Ground> grounds{};
    /// Triangles of all or some of the parts; null if not needed.
    std::shared_ptr<const RenderableMesh> mesh{};

    /// All occluders: the union of the field and the grounds.
    AnyField surroundings() const;
};

/// The material of an object, which must not be no_object.
const Material& material_of(const Renderable& renderable, ObjectId object);

/// Whether any material has a colour for convex edges.
bool has_edge_colors(const Renderable& renderable);

/// The ground whose number is `object`, or null if `object` is a part.
const Ground* ground_of(const Renderable& renderable, ObjectId object);

/// The cells that the surface of a field passes through, for aiming a camera.
struct Outline {
    std::vector<Vec3d> points; ///< centres of the cells, scene units
    Box box;                   ///< around the cells, scene units
};

/// Searches the cube of side 1 around the origin of unit space, in cells of 1/64. \throw InputError if no cell
/// contains the surface. Cost: 64³ map() calls.
Outline outline(const AnyField& field, const Frame& frame);

struct ImageMethod; // an occlusion method for rendered images only (render/detail/image_method.h)

/// Fewer probes for distant surfels. Source: sdfao2026, where the number falls from 5 to 2 over 50 units.
struct FewerSamples {
    int far_samples = 2;   ///< samples at `distance` and beyond, >= 1
    float distance = 0.0f; ///< from the eye, unit space, > 0
};

struct RenderOptions {
    /// Rays per pixel, >= 1, averaged; at the same positions in every pixel.
    int samples = 4;
    /// Occlusion estimator; if null, ao is 1 everywhere.
    const Method* method = nullptr;
    Settings settings{};
    /// If set, replaces `method` and uses the same settings.
    const ImageMethod* image_method = nullptr;
    /// For methods with a parameter `samples`: if set, the number of samples is that of `settings` at the eye, and
    /// falls with the distance from it.
    std::optional<FewerSamples> fewer{};
    Lighting lighting{};
    SoftShadow shadow{};              ///< of the key light
    bool casts_shadow = false;        ///< apply the shadow in the beauty pass; no effect on the shadow pass
    PassSet passes = standard_passes; ///< passes to render; values that none of them needs are not computed
};

/// A key light from the upper left, on the camera's side of its target, and a sky in direction `up`.
Lighting studio_lighting(const Camera& camera, const Vec3d& up);

/// The number of probes at `distance` from the eye (unit space), interpolated linearly between `near_samples` and
/// `fewer.far_samples`.
int samples_at(float distance, int near_samples, const FewerSamples& fewer);

/// Renders in regions of 262,144 samples, and so needs only about 100 MB besides the image. All values are finite.
/// Cost: the camera rays (detail/camera_rays.h), plus the estimator once per sample that hits.
Image render(const Renderable& renderable, const Camera& camera, const RenderOptions& options,
             const Progress& progress = {});

}
