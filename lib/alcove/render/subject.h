/// What is in front of the camera: a field, and where in the scene it is.
#pragma once

#include "alcove/field/any_field.h"

#include <vector>

namespace alcove {

struct Subject {
    AnyField field; ///< unit space
    Frame frame;    ///< of that unit space
    Box box;        ///< scene units; nothing outside it is drawn
};

/// The subject of a field without a mesh, within the cube of side 1 around the origin of unit space: cells of
/// 1/64 that the surface passes through, as points to aim a camera at. \throw InputError if there are none.
/// Cost: 64³ map() calls.
struct Outline {
    std::vector<Vec3d> points; ///< centres of the cells, scene units
    Box box;                   ///< around the cells
};
Outline outline(const AnyField& field, const Frame& frame);

}
