/// How far all rays of a tile of the image may go at once: cones, marched like rays.
#pragma once

#include "alcove/field/field.h"

#include <span>

namespace alcove {

/// Rays from one point: at the length t along each of them it is no further than slope·t from eye + t·axis.
struct Cone {
    Vec3d axis;       ///< unit length
    double slope;     ///< > 0
    double travelled; ///< in: a length before which no ray meets anything; out: the largest that is found
};

/// Moves cones forward while the field, less a `margin`, is larger than they are wide there; those that pass `far` meet
/// nothing, and end at a value of at least that. Unit space. The cones are those of J. Amanatides, "Ray tracing with
/// cones" (1984), marched as rays are in J. C. Hart, "Sphere tracing" (1996). Cost: up to 48 map() calls a cone.
void march_cones(const AnyField& field, const Vec3d& eye, std::span<Cone> cones, double far, float margin);

}
