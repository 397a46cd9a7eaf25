/// The triangles behind a field, for what fields do not have: normals of a mesh, painted values, and exact rays.
#pragma once

#include "alcove/occlusion/exact.h"

#include <vector>

namespace alcove {

struct SubjectMesh {
    RaySurface surface;         ///< unit space
    std::vector<Vec3> normals;  ///< one a position, of any length; zero: that of the field is kept
    std::vector<float> painted; ///< one a position, in [0, 1]: multiplies occlusion
};

}
