#include "alcove/scene/detail/loaded_shapes.h"

#include "alcove/base/types.h"
#include "alcove/field/level_stack.h"
#include "alcove/mesh/read.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/render/renderer.h"
#include "alcove/scene/detail/support.h"
#include "alcove/vdb/vdb_file.h"

#include <cmath>

namespace alcove {
namespace {

LoadedShape load(const SceneObject& object, const Pose& outer);

void add(Box& box, const Box& other) {
    box.add(other.min);
    box.add(other.max);
}

void load_mesh(const MeshShape& shape, LoadedShape& loaded) {
    loaded.mesh = read_mesh(shape.file);
    loaded.warnings = loaded.mesh.warnings;
    loaded.triangles = triangulate(loaded.mesh).triangles;
    for (const Vec3d& p : loaded.mesh.positions)
        if (is_finite(p))
            loaded.box.add(loaded.pose(p));
}

void load_grid(const GridShape& shape, LoadedShape& loaded) {
    loaded.stack = read_grids(shape.file, {shape.names});
    loaded.warnings = loaded.stack.warnings;
    try {
        add(loaded.box, posed(outline(LevelStack(loaded.stack), loaded.stack.frame).box, loaded.pose));
    } catch (const InputError& error) {
        throw InputError(shape.file.string() + ": " + error.what());
    }
}

void load_parts(const CompositeShape& shape, LoadedShape& loaded) {
    const bool unite = shape.operation == CompositeShape::Operation::unite;
    for (const SceneObject& object : shape.parts) {
        loaded.parts.push_back(load(object, loaded.pose));
        if (!unite && loaded.parts.size() > 1)
            continue;
        const Box& box = loaded.parts.back().box;
        if (box.empty())
            throw InputError(object.name +
                             ": is infinite, so it can only be subtracted from other parts: use a large box");
        add(loaded.box, box);
    }
    // A blend bulges where faces are flush: by a quarter of its width for two parts, never by more than its width.
    double bulge = 0.0;
    for (std::size_t i = 1; unite && i < shape.parts.size() && shape.blend > 0.0; ++i)
        bulge += std::pow(shape.blend - bulge, 2.0) / (4.0 * shape.blend);
    bulge *= loaded.pose.scale;
    loaded.box.min -= bulge;
    loaded.box.max += bulge;
}

LoadedShape load(const SceneObject& object, const Pose& outer) {
    LoadedShape loaded{&object, outer * pose_of(object.placement)};
    loaded.box = box_of(object.shape, loaded.pose);
    if (const auto* mesh = std::get_if<MeshShape>(&object.shape))
        load_mesh(*mesh, loaded);
    if (const auto* grid = std::get_if<GridShape>(&object.shape))
        load_grid(*grid, loaded);
    if (const auto* composite = std::get_if<CompositeShape>(&object.shape))
        load_parts(*composite, loaded);
    return loaded;
}

}

std::vector<LoadedShape> load_shapes(const Scene& scene) {
    std::vector<LoadedShape> shapes;
    for (const SceneObject& object : scene.objects)
        shapes.push_back(load(object, Pose{}));
    return shapes;
}

}
