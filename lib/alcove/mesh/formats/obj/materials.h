/// The colours that the material files (.mtl) of an OBJ give its faces.
#pragma once

#include "alcove/mesh/mesh.h"

#include <optional>
#include <string>
#include <vector>

namespace alcove {

struct FaceMaterials {
    std::vector<std::optional<Vec3>> diffuse; ///< the Kd of each face, in [0, 1]; empty if the mesh has no material
    std::vector<std::string> warnings;        ///< files that cannot be read, and what materials have besides Kd
};

/// Reads the files that the 'mtllib' lines of an OBJ name, relative to its folder, or else beside it. Takes what it can
/// read and never throws InputError: whatever is missing is a warning. For other meshes, the result is empty.
FaceMaterials read_materials(const Mesh& mesh);

/// Whether the mesh is an OBJ that names materials.
bool has_materials(const Mesh& mesh);

}
