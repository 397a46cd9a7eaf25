/// The meshes of a glTF scene with their transforms and names.
#pragma once

#include "alcove/base/types.h"
#include "alcove/mesh/formats/gltf/gltf_file.h"

#include <glm/mat4x4.hpp>

#include <string>
#include <vector>

namespace alcove {

/// A mesh as a node places it in the scene.
struct GltfPlacement {
    std::size_t node = 0, mesh = 0;
    glm::dmat4 to_scene{1.0};
    std::vector<std::string> names; ///< of the node, its ancestors and the mesh
    bool is_skinned = false;
};

/// The meshes of the default scene, or of all root nodes if there is none, in depth-first order. With
/// EXT_mesh_gpu_instancing, one entry per instance. A skinned mesh is in its bind pose, placed by its first joint.
/// \throw InputError if a node is its own ancestor or has two parents, or a transform is not finite; LimitError for
/// more than a million instances.
std::vector<GltfPlacement> placements_of(GltfFile& file);

}
