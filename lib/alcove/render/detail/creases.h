/// Reconstructs the sharp edges of level sets, which interpolation rounds off.
#pragma once

#include "alcove/field/field.h"

#include <optional>

namespace alcove {

/// The distance by which to move a hit on the rounded surface of a level set along its ray, onto the extended planes
/// of a nearby sharp edge (after Kobbelt et al. 2001). Unit space; negative moves it toward the eye.
///
/// Empty if the ray hits the surface so steeply that rounding moves the hit by less than a voxel, if no edge is nearby
/// (distances there are not those to two or three planes), and in exact and two-sided fields. `gradient` is from
/// central differences at the hit and has length 1 over a plane. Thread-safe. Cost: none for steep hits, else 1 map()
/// call; 99 near edges.
std::optional<float> meet_crease(const AnyField& field, const Vec3& hit, const Vec3& gradient, const Vec3& direction);

}
