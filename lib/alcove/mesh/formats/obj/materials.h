/// The colours that the material files (.mtl) of an OBJ give to its faces.
#pragma once

#include "alcove/mesh/mesh.h"

#include <optional>
#include <string>
#include <vector>

namespace alcove {

struct FaceMaterials {
    std::vector<std::optional<Vec3>> diffuse; ///< the Kd of each face, in [0, 1]; empty if the mesh has no material
    std::vector<std::string> warnings;        ///< about unreadable files, and properties of materials other than Kd
};

/// Reads the files named by an OBJ's 'mtllib' lines. Looks for each first at the given path, relative to the OBJ's
/// folder, then by file name alone in that folder. Reads as much as it can and never throws InputError: missing files
/// and materials cause warnings. For other meshes, the result is empty.
FaceMaterials read_materials(const Mesh& mesh);

/// Whether the mesh is an OBJ that names materials.
bool has_materials(const Mesh& mesh);

}
