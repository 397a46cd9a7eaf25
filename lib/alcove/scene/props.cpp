#include "alcove/scene/props.h"

#include "alcove/errors.h"
#include "alcove/field/level_stack.h"
#include "alcove/grid/grid_io.h"
#include "alcove/mesh/read.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/render/subject.h"
#include "alcove/scene/support.h"

#include <cmath>

namespace alcove {
namespace {

Prop fetch(const SceneObject& object, const Pose& outer);

void add(Box& box, const Box& other) {
    box.add(other.min);
    box.add(other.max);
}

void fetch_mesh(const MeshShape& shape, Prop& prop) {
    prop.mesh = read_mesh(shape.file);
    prop.warnings = prop.mesh.warnings;
    prop.triangles = triangulate(prop.mesh).triangles;
    for (const Vec3d& p : prop.mesh.positions)
        if (is_finite(p))
            prop.box.add(prop.pose(p));
}

void fetch_grid(const GridShape& shape, Prop& prop) {
    prop.stack = read_grids(shape.file);
    prop.warnings = prop.stack.warnings;
    try {
        add(prop.box, posed(outline(LevelStack(prop.stack), prop.stack.frame).box, prop.pose));
    } catch (const InputError& error) {
        throw InputError(shape.file.string() + ": " + error.what());
    }
}

void fetch_parts(const CompositeShape& shape, Prop& prop) {
    const bool unite = shape.operation == CompositeShape::Operation::unite;
    for (const SceneObject& object : shape.parts) {
        prop.parts.push_back(fetch(object, prop.pose));
        if (!unite && prop.parts.size() > 1)
            continue;
        const Box& box = prop.parts.back().box;
        if (box.empty())
            throw InputError(object.name +
                             ": has no end, so it can only be cut away from others: use a large box");
        add(prop.box, box);
    }
    // Where faces are flush a blend bulges: a quarter of its width for two parts, never more than the width.
    double bulge = 0.0;
    for (std::size_t i = 1; unite && i < shape.parts.size() && shape.blend > 0.0; ++i)
        bulge += std::pow(shape.blend - bulge, 2.0) / (4.0 * shape.blend);
    bulge *= prop.pose.scale;
    prop.box.min -= bulge;
    prop.box.max += bulge;
}

Prop fetch(const SceneObject& object, const Pose& outer) {
    Prop prop{&object, outer * pose_of(object.placement)};
    prop.box = box_of(object.shape, prop.pose);
    if (const auto* mesh = std::get_if<MeshShape>(&object.shape))
        fetch_mesh(*mesh, prop);
    if (const auto* grid = std::get_if<GridShape>(&object.shape))
        fetch_grid(*grid, prop);
    if (const auto* composite = std::get_if<CompositeShape>(&object.shape))
        fetch_parts(*composite, prop);
    return prop;
}

}

std::vector<Prop> fetch_props(const Scene& scene) {
    std::vector<Prop> props;
    for (const SceneObject& object : scene.objects)
        props.push_back(fetch(object, Pose{}));
    return props;
}

}
