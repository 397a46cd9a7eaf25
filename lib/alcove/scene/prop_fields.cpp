#include "alcove/scene/prop_fields.h"

#include "alcove/errors.h"
#include "alcove/field/blend.h"
#include "alcove/field/level_stack.h"
#include "alcove/grid/mesh_grid.h"
#include "alcove/scene/missing_walls.h"

#include <fmt/format.h>

#include <algorithm>

namespace alcove {
namespace {

/// A visitor made of lambdas.
template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

/// A field of the unit space of `own`, a frame in the space of the prop.
template <Field F>
AnyField put(F field, const Frame& own, const Prop& prop, const Stage& stage) {
    return Transformed<F>{std::move(field), glm::mat3(prop.pose.rotation),
                          static_cast<float>(prop.pose.scale * own.diagonal / stage.frame.diagonal),
                          stage.frame.to_unit(prop.pose(own.center))};
}

AnyField put_stack(const Prop& prop, const Stage& stage) {
    const Pose& pose = prop.pose;
    if (pose.rotation != glm::dmat3(1.0))
        return put(LevelStack(prop.stack), prop.stack.frame, prop, stage);
    // What is not turned needs no arithmetic a point: the unit space of the scene, as a frame in the prop's space.
    const Frame of_stage{(stage.frame.center - pose.translation) / pose.scale,
                         stage.frame.diagonal / pose.scale};
    return LevelStack(reframed(prop.stack, of_stage));
}

/// A length of the stage, in the unit space of a frame in the space of the prop.
float in_unit_of(const Frame& own, float length, const Prop& prop, const Stage& stage) {
    return static_cast<float>(double(length) * stage.frame.diagonal / (own.diagonal * prop.pose.scale));
}

AnyField voxelized(const MeshShape& shape, Prop& prop, const Stage& stage, bool inside) {
    const Frame own = frame_of(prop.mesh.box());
    VoxelizeOptions options;
    options.sign = shape.sign;
    const float radius = in_unit_of(own, stage.radius, prop, stage);
    options.grid.radius = std::max(radius, in_unit_of(own, stage.reach, prop, stage));
    options.grid.largest_voxel = chosen_voxel(radius, options.grid.largest_voxel);
    options.grid.memory_limit = stage.memory_limit;
    if (inside)
        options.grid.inner_band = options.grid.outer_band;
    options.progress = stage.progress;
    try {
        if (shape.voxel)
            options.grid.voxel = shape.voxel->to_unit(own.diagonal);
        prop.stack = voxelize(prop.mesh, prop.triangles, options);
    } catch (const InputError& error) {
        throw InputError(shape.file.string() + ": " + error.what());
    } catch (const LimitError& error) {
        throw LimitError(shape.file.string() + ": " + error.what());
    }
    AnyField field = put_stack(prop, stage);
    const std::vector<std::string>& warnings = prop.stack.warnings;
    prop.warnings.insert(prop.warnings.end(), warnings.begin(), warnings.end());
    if (std::string missing = missing_walls(prop, field, stage.frame, options.grid); !missing.empty())
        prop.warnings.push_back(std::move(missing));
    return field;
}

void extend_grid(const GridShape& shape, Prop& prop, const Stage& stage, bool inside) {
    const float reach = prop.stack.reach();
    const float wanted = std::min(in_unit_of(prop.stack.frame, stage.reach, prop, stage), 1.0f);
    if (reach >= wanted && !inside)
        return;
    if (prop.stack.sign == Sign::sheet) {
        if (reach >= wanted)
            return;
        prop.warnings.push_back(fmt::format(
            "{} holds distances up to {:.4g}, less than occlusion and shadows ask: beyond them these are "
            "guessed; voxelize its mesh with a larger --radius",
            shape.file.string(), reach * prop.stack.frame.diagonal));
        return;
    }
    try {
        prop.stack = extend_levels(std::move(prop.stack), std::max(wanted, reach), inside);
    } catch (const InputError& error) {
        throw InputError(shape.file.string() + ": " + error.what());
    } catch (const LimitError& error) {
        throw LimitError(shape.file.string() + ": " + error.what());
    }
}

AnyField composite(const CompositeShape& shape, Prop& prop, const Stage& stage, bool inside) {
    const bool unite = shape.operation == CompositeShape::Operation::unite;
    const auto width = static_cast<float>(shape.blend * prop.pose.scale / stage.frame.diagonal);
    // A blend asks for distances as far as its width beyond what is asked of it, and a cut for those of the inside.
    Stage wider = stage;
    wider.reach += width;
    std::vector<AnyField> fields;
    for (Prop& part : prop.parts) {
        const bool cuts = !unite && (!fields.empty() || width > 0.0f);
        fields.push_back(field_of(part, wider, inside || cuts));
        if (two_sided(fields.back()) && (!unite || shape.blend > 0.0))
            throw InputError(
                fmt::format("{}: is open, and only solids are {}: close it, or say sign = \"signed\"",
                            part.object->name, unite ? "blended" : "cut or cut away"));
    }
    if (!unite)
        return Difference<AnyField>(std::move(fields), width);
    if (width > 0.0f)
        return BlendedUnion<AnyField>(std::move(fields), width);
    return UnionOf<AnyField>(std::move(fields));
}

}

Plane plane_of(const Prop& prop, const Frame& frame) {
    const PlaneShape& shape = std::get<PlaneShape>(prop.object->shape);
    const Vec3d normal = glm::normalize(prop.pose.rotation * glm::normalize(shape.normal));
    return {Vec3(normal), glm::dot(Vec3(normal), frame.to_unit(prop.pose(shape.point)))};
}

AnyField field_of(Prop& prop, const Stage& stage, bool inside) {
    return std::visit(
        Overloaded{[&](const SphereShape& s) {
                       return put(Sphere{}, {s.center, s.radius}, prop, stage);
                   },
                   [&](const BoxShape& s) {
                       const double size = glm::length(s.size);
                       return put(Cuboid{{}, Vec3(0.5 * s.size / size)}, {s.center, size}, prop, stage);
                   },
                   [&](const TorusShape& s) {
                       return put(Torus{{}, 1.0f, static_cast<float>(s.tube / s.ring)}, {s.center, s.ring},
                                  prop, stage);
                   },
                   [&](const CapsuleShape& s) {
                       const Frame own{0.5 * (s.start + s.end), glm::length(s.end - s.start) + s.radius};
                       return put(Capsule{own.to_unit(s.start), own.to_unit(s.end),
                                          static_cast<float>(s.radius / own.diagonal)},
                                  own, prop, stage);
                   },
                   [&](const PlaneShape&) { return AnyField(plane_of(prop, stage.frame)); },
                   [&](const MeshShape& s) { return voxelized(s, prop, stage, inside); },
                   [&](const GridShape& s) {
                       extend_grid(s, prop, stage, inside);
                       return put_stack(prop, stage);
                   },
                   [&](const CompositeShape& s) { return composite(s, prop, stage, inside); }},
        prop.object->shape);
}

}
