/// Where a surfel lies among the faces that it touches.
#pragma once

#include "alcove/base/types.h"

#include <array>
#include <functional>
#include <span>

namespace alcove {

/// A triangle with an area, relative to the position of a surfel.
struct NearFace {
    std::array<Vec3d, 3> corners;
    Vec3d normal; ///< unit length
};

/// The members have the same meaning as in Surfel.
struct Contact {
    Vec3 away{0.0f};
    bool covered = false;
};

/// The contact of a surfel with `others`, the faces within `offset` of it that are not its `own` faces.
///
/// Another face counts if the surfel's hemisphere can see it, if part of it is in front of an own face, and if it
/// neither lies in the plane of all own faces nor continues them across an edge or a split vertex. The normal of such a
/// face is added to `away`, pointing to the side on which the own faces lie, or to the front of the face if they lie on
/// both sides. Faces in one plane count once.
///
/// The surfel is covered if it lies inside a union of faces that are in the plane of all own faces and face the
/// opposite way. Exact duplicates of own faces count as covering faces only if `between_solids()`: the two sides of a
/// leaf card do not cover each other.
Contact contact_of(const Vec3& normal, std::span<const NearFace> own, std::span<const NearFace> others, double offset,
                   const std::function<bool()>& between_solids);

}
