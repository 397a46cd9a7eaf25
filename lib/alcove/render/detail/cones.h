/// Cone marching: how far all rays of an image tile can advance together.
#pragma once

#include "alcove/field/field.h"

#include <span>

namespace alcove {

/// A cone around rays from one point: at length t, every ray is within slope·t of eye + t·axis.
struct Cone {
    Vec3d axis;       ///< unit length
    double slope;     ///< > 0
    double travelled; ///< in: a length before which no ray hits anything; out: the largest such length found
};

/// Advances the cones (Amanatides 1984) by sphere tracing (Hart 1996) while the field minus `margin` clearly exceeds
/// their radius. Cones that reach `far` hit nothing, and their `travelled` is then at least `far`. Unit space. Cost: up
/// to 48 map() calls per cone.
void march_cones(const AnyField& field, const Vec3d& eye, std::span<Cone> cones, double far, float margin);

}
