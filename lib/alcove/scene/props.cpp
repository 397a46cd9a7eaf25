#include "alcove/scene/props.h"

#include "alcove/errors.h"
#include "alcove/field/level_stack.h"
#include "alcove/grid/grid_io.h"
#include "alcove/mesh/read.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/render/subject.h"

#include <fmt/format.h>

namespace alcove {
namespace {

Prop fetch(const SceneObject& object, const Pose& outer);

Box around(const Vec3d& center, const Vec3d& half) {
    return {center - half, center + half};
}

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
    // Where faces are flush a blend bulges.
    const double bulge = unite ? 0.25 * shape.blend * prop.pose.scale : 0.0;
    prop.box.min -= bulge;
    prop.box.max += bulge;
}

Prop fetch(const SceneObject& object, const Pose& outer) {
    Prop prop{&object, outer * pose_of(object.placement)};
    const auto take = [&](const Box& box) { prop.box = posed(box, prop.pose); };
    std::visit(
        Overloaded{[&](const SphereShape& s) { take(around(s.center, Vec3d(s.radius))); },
                   [&](const BoxShape& s) { take(around(s.center, 0.5 * s.size)); },
                   [&](const TorusShape& s) {
                       const double outside = s.ring + s.tube;
                       take(around(s.center, {outside, s.tube, outside}));
                   },
                   [&](const CapsuleShape& s) {
                       take({glm::min(s.start, s.end) - s.radius, glm::max(s.start, s.end) + s.radius});
                   },
                   [](const PlaneShape&) {}, [&](const MeshShape& s) { fetch_mesh(s, prop); },
                   [&](const GridShape& s) { fetch_grid(s, prop); },
                   [&](const CompositeShape& s) { fetch_parts(s, prop); }},
        object.shape);
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
