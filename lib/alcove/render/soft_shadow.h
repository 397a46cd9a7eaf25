/// How much of the sun arrives, with soft edges from the field alone.
#pragma once

#include "alcove/field/field.h"

#include <span>
#include <vector>

namespace alcove {

/// Marched toward the sun from each surfel, by the distance d at the way t:
///
///     min(1, min over t of sharpness·d(p + t l)/t), 0 where the way meets the surface
///
/// Source: "SDF Ambient Occlusion — Detailed Reference" (2026), whose ways from 0.02 to 20 are in a scene of a diagonal of
/// 5.73. Lengths in unit space. A field tells nothing within two voxels, so ways begin there if that is further.
struct SoftShadow {
    float sharpness = 8.0f; ///< > 0; the larger, the harder the edges
    float begin = 0.02f / 5.73f;
    float end = 20.0f / 5.73f;
};

/// A share in [0, 1] a surfel; 0 where it faces away, 1 where it has no normal. `toward_sun` is of unit length. Thread-safe.
/// Cost: 5–30 map() calls a surfel that faces the sun.
std::vector<float> soft_shadows(std::span<const Surfel> surfels, const AnyField& field,
                                const Vec3& toward_sun, const SoftShadow& shadow = {});

}
