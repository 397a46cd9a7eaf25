/// The triangles behind a field, for what fields do not have: normals of a mesh, painted values, and exact rays.
#pragma once

#include "alcove/occlusion/occluders.h"

#include <cstdint>
#include <vector>

namespace alcove {

/// What a sample of an image shows: 0 nothing, 1 to the number of parts one of these, above them a ground.
using ObjectId = std::uint16_t;
inline constexpr ObjectId no_object = 0;

struct RenderableMesh {
    RaySurface surface;            ///< unit space
    std::vector<ObjectId> objects; ///< one a position: the part that it is of
    std::vector<Vec3> normals;     ///< one a position, of any length; zero: that of the field is kept
    std::vector<float> painted;    ///< one a position, in [0, 1]: multiplies occlusion
};

}
