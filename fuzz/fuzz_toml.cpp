// Target for the reader of scene files. It does not open the meshes that a scene names.
#include "alcove/scene/scene.h"
#include "checks.h"
#include "memory_file.h"

#include <cmath>

using namespace alcove;

namespace {

bool is_finite(const Vec3d& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void check_length(const std::optional<Length>& length) {
    fuzz::require(!length || length->value > 0.0, "lengths are above 0");
}

void check_object(const SceneObject& object) {
    fuzz::require(!object.name.empty(), "objects have names");
    const Placement& placement = object.placement;
    fuzz::require(is_finite(placement.translation) && is_finite(placement.rotation) && std::isfinite(placement.scale) &&
                      placement.scale > 0.0,
                  "placements are finite");
    if (const auto* mesh = std::get_if<MeshShape>(&object.shape)) {
        fuzz::require(!mesh->file.empty(), "meshes have files");
        check_length(mesh->voxel);
    }
    if (const auto* composite = std::get_if<CompositeShape>(&object.shape)) {
        fuzz::require(!composite->parts.empty() && composite->blend >= 0.0, "composites have parts");
        for (const SceneObject& part : composite->parts)
            check_object(part);
    }
}

void check_scene(const Scene& scene) {
    for (const SceneObject& object : scene.objects)
        check_object(object);
    check_length(scene.occlusion.radius);
    fuzz::require(!scene.light.toward_sun || *scene.light.toward_sun != Vec3d(0.0),
                  "the direction of the sun is not zero");
    fuzz::require(scene.camera.fov >= 1.0 && scene.camera.fov <= 170.0, "the field of view is in range");
    fuzz::require(scene.size.width >= 1 && scene.size.width <= longest_side && scene.size.height >= 1 &&
                      scene.size.height <= longest_side && scene.samples >= 1,
                  "the size of the image is in range");
}

}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const fuzz::MemoryFile file({data, size});
    fuzz::accept_refusals(file.path().string(), [&] { check_scene(read_scene(file.path())); });
    return 0;
}
