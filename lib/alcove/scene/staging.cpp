#include "alcove/scene/staging.h"

#include "alcove/errors.h"
#include "alcove/field/combine.h"
#include "alcove/scene/prop_fields.h"
#include "alcove/scene/support.h"
#include "alcove/scene/triangles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alcove {
namespace {

constexpr double memory_limit = 4e9; // of all grids together

Box box_around(const std::vector<Prop>& props) {
    Box box;
    for (const Prop& prop : props)
        if (!prop.box.empty()) {
            box.add(prop.box.min);
            box.add(prop.box.max);
        }
    return box;
}

/// Of the grid of a prop, scene units.
double voxel_of(const Prop& prop) {
    return double(prop.stack.levels.front().voxel) * prop.stack.frame.diagonal * prop.pose.scale;
}

/// The finest voxel that the scene itself names, unit space; 0 where it names none.
float named_voxel(const std::vector<Prop>& props, const Frame& frame) {
    double finest = std::numeric_limits<double>::infinity();
    for_each_prop(props, [&](const Prop& prop) {
        if (!prop.stack.levels.empty())
            finest = std::min(finest, voxel_of(prop));
        if (const auto* mesh = std::get_if<MeshShape>(&prop.object->shape); mesh && mesh->voxel) {
            const double diagonal = prop.mesh.box().diagonal();
            finest = std::min(finest, double(mesh->voxel->to_unit(diagonal)) * diagonal * prop.pose.scale);
        }
    });
    return std::isfinite(finest) ? static_cast<float>(finest / frame.diagonal) : 0.0f;
}

std::size_t count_grids(const std::vector<Prop>& props) {
    std::size_t count = 0;
    for_each_prop(props, [&](const Prop& prop) {
        count += std::holds_alternative<MeshShape>(prop.object->shape) ||
                 std::holds_alternative<GridShape>(prop.object->shape);
    });
    return count;
}

AnyField united(const std::vector<Part>& parts) {
    if (parts.size() == 1)
        return parts.front().field;
    std::vector<AnyField> fields;
    fields.reserve(parts.size());
    for (const Part& part : parts)
        fields.push_back(part.field);
    return UnionOf<AnyField>(std::move(fields));
}

/// As far as distances are to be right. A soft shadow tells those from less than the way, over its sharpness.
float reach_of(const Scene& scene, PassSet passes, float radius, bool convexity) {
    const bool shadow = need_shadow(passes, scene.light.casts_shadow);
    const SoftShadow& shape = scene.light.shadow;
    return std::max(scene.occlusion.method || convexity ? radius : 0.0f,
                    shadow ? std::min(shape.end / shape.sharpness, 1.0f) : 0.0f);
}

/// The gradient's direction, by differences.
Vec3 steepest(const AnyField& field, const Vec3& p) {
    constexpr float h = 1e-3f;
    Vec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 step(0.0f);
        step[axis] = h;
        gradient[axis] = field.map(p + step) - field.map(p - step);
    }
    const float length = glm::length(gradient);
    return length > 0.0f ? gradient / length : Vec3(0.0f);
}

bool has_edge_colors(const Scene& scene) {
    return (scene.ground && scene.ground->material.edge_color) ||
           std::any_of(scene.objects.begin(), scene.objects.end(),
                       [](const SceneObject& object) { return object.material.edge_color.has_value(); });
}

/// The height of the lowest point, scene units: that of a shape or of vertices, else of points of the surface a 64th of
/// the prop apart, which a round bottom is lower than by a thousandth of it.
double lowest(const Prop& prop, const AnyField& field, const Frame& frame, const Vec3d& up) {
    if (const std::optional<double> height = support(prop.object->shape, prop.pose, -up))
        return -*height;
    double height = std::numeric_limits<double>::infinity();
    for (const Vec3d& p : prop.mesh.positions)
        if (is_finite(p))
            height = std::min(height, glm::dot(up, prop.pose(p)));
    if (std::isfinite(height))
        return height;
    const Frame own = frame_of(prop.box);
    const AnyField in_own = placed(field, frame, own);
    for (const Vec3d& p : outline(in_own, own).points) {
        Vec3 q = own.to_unit(p);
        for (int round = 0; round < 3; ++round)
            q -= in_own.map(q) * steepest(in_own, q);
        if (std::fabs(in_own.map(q)) < 1e-4f)
            height = std::min(height, glm::dot(up, own.to_scene(q)));
    }
    return height;
}

}

Staged stage(const Scene& scene, PassSet passes, const Progress& progress) {
    constexpr std::size_t most_objects = 60000; // numbers of 16 bits
    if (scene.objects.size() > most_objects)
        throw InputError(fmt::format("the scene has {} objects, {} at most: make unions of them",
                                     scene.objects.size(), most_objects));
    std::vector<Prop> props = fetch_props(scene);
    const Box box = box_around(props);
    const Frame frame = frame_of(box);
    const float radius = scene.occlusion.radius.to_unit(frame.diagonal, named_voxel(props, frame));
    const bool convexity = need_convexity(passes, has_edge_colors(scene));
    const Stage common{frame, radius, reach_of(scene, passes, radius, convexity),
                       memory_limit / std::max(1.0, static_cast<double>(count_grids(props))), progress};

    std::vector<Part> parts;
    std::vector<Ground> grounds;
    const Vec3d up = glm::normalize(scene.camera.up);
    double floor = std::numeric_limits<double>::infinity();
    for (Prop& prop : props) {
        const Material& material = prop.object->material;
        if (std::holds_alternative<PlaneShape>(prop.object->shape)) {
            grounds.push_back({.plane = plane_of(prop, frame), .material = material});
            continue;
        }
        parts.push_back({field_of(prop, common, convexity), material});
        if (scene.ground)
            floor = std::min(floor, lowest(prop, parts.back().field, frame, up));
    }
    if (scene.ground && (scene.ground->height || std::isfinite(floor))) {
        const double height = scene.ground->height.value_or(floor);
        grounds.push_back(
            {.plane = {Vec3(up), static_cast<float>((height - glm::dot(up, frame.center)) / frame.diagonal)},
             .whole = 1.0f,
             .gone = 5.0f,
             .material = scene.ground->material});
    }
    if (parts.empty() && grounds.empty())
        throw InputError("the scene is empty: add an [[object]]");

    auto mesh = triangles_of(props, parts, grounds, frame,
                             scene.occlusion.method && scene.occlusion.method->asks_rays);
    AnyField field = united(parts);
    std::vector<Vec3d> points;
    if (!parts.empty())
        points = outline(field, frame).points;
    Staged staged{
        .subject = {std::move(field), frame, box, std::move(parts), std::move(grounds), std::move(mesh)},
        .points = std::move(points),
        .radius = radius};
    const bool several = props.size() > 1 || std::any_of(props.begin(), props.end(), [](const Prop& prop) {
                             return !prop.parts.empty();
                         });
    for_each_prop(props, [&](const Prop& prop) {
        for (const std::string& warning : prop.warnings)
            staged.warnings.push_back(several ? prop.object->name + ": " + warning : warning);
        if (prop.stack.levels.empty())
            return;
        staged.levels = std::max(staged.levels, prop.stack.levels.size());
        staged.voxel = std::max(staged.voxel, voxel_of(prop));
    });
    return staged;
}

/// Of an estimator that traces rays: with the samples of a pixel, what a vertex of a bake has.
constexpr double rays_a_sample = 16.0;

RenderOptions rendering_of(const Scene& scene, const Staged& staged, const Camera& camera, PassSet passes) {
    RenderOptions options{.samples = scene.samples,
                          .method = scene.occlusion.method,
                          .settings = {staged.radius, scene.occlusion.parameters},
                          .image_method = scene.occlusion.image_method,
                          .lighting = studio_lighting(camera, scene.camera.up),
                          .shadow = scene.light.shadow,
                          .casts_shadow = scene.light.casts_shadow,
                          .passes = passes};
    options.lighting.use = scene.occlusion.use;
    if (scene.occlusion.far_samples && options.method && options.method->has_parameter("samples"))
        options.fewer = FewerSamples{*scene.occlusion.far_samples,
                                     static_cast<float>(scene.occlusion.far / staged.subject.frame.diagonal)};
    if (options.method)
        for (const ParameterInfo& parameter : options.method->parameters())
            if (parameter.name == "rays" && parameter.standard > rays_a_sample)
                options.settings.parameters.emplace(options.settings.parameters.begin(), "rays",
                                                    rays_a_sample);
    // A plane without an end is near probes however far they are.
    if (!staged.subject.grounds.empty())
        options.settings.furthest_probe = 100.0f;
    const SceneLight& light = scene.light;
    options.lighting.toward_key =
        light.toward_sun ? Vec3(glm::normalize(*light.toward_sun)) : options.lighting.toward_key;
    options.lighting.key = light.sun.value_or(options.lighting.key);
    options.lighting.sky = light.sky.value_or(options.lighting.sky);
    options.lighting.ground = light.bounce.value_or(options.lighting.ground);
    return options;
}

}
