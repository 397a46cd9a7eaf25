#include "alcove/scene/detail/shape_fields.h"

#include "alcove/base/types.h"
#include "alcove/field/detail/blend.h"

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

/// The width of the rounded seams, unit space.
float blend_of(const CompositeShape& shape, const LoadedShape& loaded, const Frame& frame) {
    return static_cast<float>(shape.blend * loaded.pose.scale / frame.diagonal);
}

AnyField composite(const CompositeShape& shape, LoadedShape& loaded, const Frame& frame, SharedGrids& grids) {
    const bool unite = shape.operation == CompositeShape::Operation::unite;
    const float width = blend_of(shape, loaded, frame);
    std::vector<AnyField> fields;
    for (LoadedShape& part : loaded.parts) {
        fields.push_back(field_of(part, frame, grids));
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

void set_reach(LoadedShape& loaded, float reach, bool inside, const Frame& frame) {
    loaded.reach = reach;
    loaded.inside = inside;
    const auto* shape = std::get_if<CompositeShape>(&loaded.object->shape);
    if (!shape)
        return;
    // A blend needs distances up to its width beyond the requested reach. A subtracted part needs the distances inside
    // it.
    const float width = blend_of(*shape, loaded, frame);
    const bool subtracts = shape->operation == CompositeShape::Operation::subtract;
    for (std::size_t i = 0; i < loaded.parts.size(); ++i)
        set_reach(loaded.parts[i], reach + width, inside || (subtracts && (i > 0 || width > 0.0f)), frame);
}

AnyField field_of(LoadedShape& loaded, const Frame& frame, SharedGrids& grids) {
    const auto put = [&](auto field, const Frame& own) { return posed(std::move(field), own, loaded.pose, frame); };
    return std::visit(
        Overloaded{[&](const SphereShape& s) {
                       return put(Sphere{}, {s.center, s.radius});
                   },
                   [&](const BoxShape& s) {
                       const double size = glm::length(s.size);
                       return put(Cuboid{{}, Vec3(0.5 * s.size / size)}, {s.center, size});
                   },
                   [&](const TorusShape& s) {
                       return put(Torus{{}, 1.0f, static_cast<float>(s.tube / s.ring)}, {s.center, s.ring});
                   },
                   [&](const CapsuleShape& s) {
                       const Frame own{0.5 * (s.start + s.end), glm::length(s.end - s.start) + s.radius};
                       return put(Capsule{own.to_unit(s.start), own.to_unit(s.end),
                                          static_cast<float>(s.radius / own.diagonal)},
                                  own);
                   },
                   [&](const PlaneShape&) { return AnyField(plane_of(loaded, frame)); },
                   [&](const MeshShape&) { return grids.field(loaded); },
                   [&](const GridShape&) { return grids.field(loaded); },
                   [&](const CompositeShape& s) { return composite(s, loaded, frame, grids); }},
        loaded.object->shape);
}

}
