#include "alcove/occlusion/occluders.h"

#include "alcove/errors.h"

namespace alcove {

const AnyField& Occluders::field() const {
    if (!field_)
        throw InputError("there is no grid here for a method that probes one");
    return *field_;
}

const RaySurface& Occluders::rays() const {
    if (!rays_)
        throw InputError("there are no triangles here for a method that traces them: use traced");
    return *rays_;
}

}
