#include "alcove/scene/detail/shape_fields.h"

#include "alcove/base/types.h"
#include "alcove/field/detail/blend.h"
#include "alcove/field/level_stack.h"
#include "alcove/grid/voxelize.h"
#include "alcove/scene/detail/missing_walls.h"

#include <fmt/format.h>

#include <algorithm>

namespace alcove {
namespace {

/// A visitor composed of lambdas.
template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

/// Transforms a field from the unit space of `own`, a frame in the space of the shape, to that of the scene.
template <Field F>
AnyField put(F field, const Frame& own, const LoadedShape& loaded, const BuildContext& context) {
    return Transformed<F>{std::move(field), glm::mat3(loaded.pose.rotation),
                          static_cast<float>(loaded.pose.scale * own.diagonal / context.frame.diagonal),
                          context.frame.to_unit(loaded.pose(own.center))};
}

AnyField put_stack(const LoadedShape& loaded, const BuildContext& context) {
    const Pose& pose = loaded.pose;
    if (pose.rotation != glm::dmat3(1.0))
        return put(LevelStack(loaded.stack), loaded.stack.frame, loaded, context);
    // Without a rotation, reframing the grid avoids transforming every point.
    const Frame scene_frame{(context.frame.center - pose.translation) / pose.scale,
                            context.frame.diagonal / pose.scale};
    return LevelStack(reframed(loaded.stack, scene_frame));
}

/// Converts a length from the unit space of the scene to that of `own`, a frame in the space of the shape.
float in_unit_of(const Frame& own, float length, const LoadedShape& loaded, const BuildContext& context) {
    return static_cast<float>(double(length) * context.frame.diagonal / (own.diagonal * loaded.pose.scale));
}

AnyField voxelized(const MeshShape& shape, LoadedShape& loaded, const BuildContext& context, bool inside) {
    const Frame own = frame_of(loaded.mesh.box());
    VoxelizeOptions options;
    options.sign = shape.sign;
    const float radius = in_unit_of(own, context.radius, loaded, context);
    options.grid.radius = std::max(radius, in_unit_of(own, context.reach, loaded, context));
    options.grid.largest_voxel = chosen_voxel(radius, options.grid.largest_voxel);
    options.grid.memory_limit = context.memory_limit;
    if (inside)
        options.grid.inner_band = options.grid.outer_band;
    options.progress = context.progress;
    try {
        if (shape.voxel)
            options.grid.voxel = shape.voxel->to_unit(own.diagonal);
        loaded.stack = voxelize(loaded.mesh, loaded.triangles, options);
    } catch (const InputError& error) {
        throw InputError(shape.file.string() + ": " + error.what());
    } catch (const LimitError& error) {
        throw LimitError(shape.file.string() + ": " + error.what());
    }
    AnyField field = put_stack(loaded, context);
    const std::vector<std::string>& warnings = loaded.stack.warnings;
    loaded.warnings.insert(loaded.warnings.end(), warnings.begin(), warnings.end());
    if (std::string missing = missing_walls(loaded, field, context.frame, options.grid); !missing.empty())
        loaded.warnings.push_back(std::move(missing));
    return field;
}

void extend_grid(const GridShape& shape, LoadedShape& loaded, const BuildContext& context, bool inside) {
    const float reach = loaded.stack.reach();
    const float wanted = std::min(in_unit_of(loaded.stack.frame, context.reach, loaded, context), 1.0f);
    if (reach >= wanted && !inside)
        return;
    if (loaded.stack.sign == Sign::sheet) {
        if (reach >= wanted)
            return;
        loaded.warnings.push_back(
            fmt::format("{} holds distances up to {:.4g}, less than occlusion and shadows need: larger ones are "
                        "guessed; voxelize its mesh with a larger --radius",
                        shape.file.string(), reach * loaded.stack.frame.diagonal));
        return;
    }
    try {
        loaded.stack = extend_levels(std::move(loaded.stack), std::max(wanted, reach), inside);
    } catch (const InputError& error) {
        throw InputError(shape.file.string() + ": " + error.what());
    } catch (const LimitError& error) {
        throw LimitError(shape.file.string() + ": " + error.what());
    }
}

AnyField composite(const CompositeShape& shape, LoadedShape& loaded, const BuildContext& context, bool inside) {
    const bool unite = shape.operation == CompositeShape::Operation::unite;
    const auto width = static_cast<float>(shape.blend * loaded.pose.scale / context.frame.diagonal);
    // A blend needs distances up to its width beyond the requested reach; a subtracted part needs those inside.
    BuildContext wider = context;
    wider.reach += width;
    std::vector<AnyField> fields;
    for (LoadedShape& part : loaded.parts) {
        const bool cuts = !unite && (!fields.empty() || width > 0.0f);
        fields.push_back(field_of(part, wider, inside || cuts));
        if (two_sided(fields.back()) && (!unite || shape.blend > 0.0))
            throw InputError(fmt::format("{}: is open, but {} takes only solids: close it, or set sign = \"solid\"",
                                         part.object->name, unite ? "a blend" : "a difference"));
    }
    if (!unite)
        return Difference<AnyField>(std::move(fields), width);
    if (width > 0.0f)
        return BlendedUnion<AnyField>(std::move(fields), width);
    return UnionOf<AnyField>(std::move(fields));
}

}

Plane plane_of(const LoadedShape& loaded, const Frame& frame) {
    const PlaneShape& shape = std::get<PlaneShape>(loaded.object->shape);
    const Vec3d normal = glm::normalize(loaded.pose.rotation * glm::normalize(shape.normal));
    return {Vec3(normal), glm::dot(Vec3(normal), frame.to_unit(loaded.pose(shape.point)))};
}

AnyField field_of(LoadedShape& loaded, const BuildContext& context, bool inside) {
    return std::visit(
        Overloaded{
            [&](const SphereShape& s) {
                return put(Sphere{}, {s.center, s.radius}, loaded, context);
            },
            [&](const BoxShape& s) {
                const double size = glm::length(s.size);
                return put(Cuboid{{}, Vec3(0.5 * s.size / size)}, {s.center, size}, loaded, context);
            },
            [&](const TorusShape& s) {
                return put(Torus{{}, 1.0f, static_cast<float>(s.tube / s.ring)}, {s.center, s.ring}, loaded, context);
            },
            [&](const CapsuleShape& s) {
                const Frame own{0.5 * (s.start + s.end), glm::length(s.end - s.start) + s.radius};
                return put(
                    Capsule{own.to_unit(s.start), own.to_unit(s.end), static_cast<float>(s.radius / own.diagonal)}, own,
                    loaded, context);
            },
            [&](const PlaneShape&) { return AnyField(plane_of(loaded, context.frame)); },
            [&](const MeshShape& s) { return voxelized(s, loaded, context, inside); },
            [&](const GridShape& s) {
                extend_grid(s, loaded, context, inside);
                return put_stack(loaded, context);
            },
            [&](const CompositeShape& s) { return composite(s, loaded, context, inside); }},
        loaded.object->shape);
}

}
