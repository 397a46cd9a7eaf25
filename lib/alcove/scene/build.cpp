#include "alcove/scene/build.h"

#include "alcove/base/errors.h"
#include "alcove/field/combine.h"
#include "alcove/scene/detail/shape_fields.h"
#include "alcove/scene/detail/support.h"
#include "alcove/scene/detail/triangles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alcove {
namespace {

constexpr double memory_limit = 4e9; // of all grids together

Box box_around(const std::vector<LoadedShape>& shapes) {
    Box box;
    for (const LoadedShape& loaded : shapes)
        if (!loaded.box.empty()) {
            box.add(loaded.box.min);
            box.add(loaded.box.max);
        }
    return box;
}

/// Of the grid of a loaded, scene units.
double voxel_of(const LoadedShape& loaded) {
    return double(loaded.stack.levels.front().voxel) * loaded.stack.frame.diagonal * loaded.pose.scale;
}

/// The finest voxel that the scene itself names, unit space; 0 where it names none.
float named_voxel(const std::vector<LoadedShape>& shapes, const Frame& frame) {
    double finest = std::numeric_limits<double>::infinity();
    for_each_shape(shapes, [&](const LoadedShape& loaded) {
        if (!loaded.stack.levels.empty())
            finest = std::min(finest, voxel_of(loaded));
        if (const auto* mesh = std::get_if<MeshShape>(&loaded.object->shape); mesh && mesh->voxel) {
            const double diagonal = loaded.mesh.box().diagonal();
            finest = std::min(finest, double(mesh->voxel->to_unit(diagonal)) * diagonal * loaded.pose.scale);
        }
    });
    return std::isfinite(finest) ? static_cast<float>(finest / frame.diagonal) : 0.0f;
}

std::size_t count_grids(const std::vector<LoadedShape>& shapes) {
    std::size_t count = 0;
    for_each_shape(shapes, [&](const LoadedShape& loaded) {
        count += std::holds_alternative<MeshShape>(loaded.object->shape) ||
                 std::holds_alternative<GridShape>(loaded.object->shape);
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
/// the loaded apart, which a round bottom is lower than by a thousandth of it.
double lowest(const LoadedShape& loaded, const AnyField& field, const Frame& frame, const Vec3d& up) {
    if (const std::optional<double> height = support(loaded.object->shape, loaded.pose, -up))
        return -*height;
    double height = std::numeric_limits<double>::infinity();
    for (const Vec3d& p : loaded.mesh.positions)
        if (is_finite(p))
            height = std::min(height, glm::dot(up, loaded.pose(p)));
    if (std::isfinite(height))
        return height;
    const Frame own = frame_of(loaded.box);
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

BuiltScene build_scene(const Scene& scene, PassSet passes, const Progress& progress) {
    constexpr std::size_t most_objects = 60000; // numbers of 16 bits
    if (scene.objects.size() > most_objects)
        throw InputError(fmt::format("the scene has {} objects, {} at most: make unions of them",
                                     scene.objects.size(), most_objects));
    std::vector<LoadedShape> shapes = load_shapes(scene);
    const Box box = box_around(shapes);
    const Frame frame = frame_of(box);
    const float radius = scene.occlusion.radius.to_unit(frame.diagonal, named_voxel(shapes, frame));
    const bool convexity = need_convexity(passes, has_edge_colors(scene));
    const BuildContext common{frame, radius, reach_of(scene, passes, radius, convexity),
                              memory_limit / std::max(1.0, static_cast<double>(count_grids(shapes))),
                              progress};

    std::vector<Part> parts;
    std::vector<Ground> grounds;
    const Vec3d up = glm::normalize(scene.camera.up);
    double floor = std::numeric_limits<double>::infinity();
    for (LoadedShape& loaded : shapes) {
        const Material& material = loaded.object->material;
        if (std::holds_alternative<PlaneShape>(loaded.object->shape)) {
            grounds.push_back({.plane = plane_of(loaded, frame), .material = material});
            continue;
        }
        parts.push_back({field_of(loaded, common, convexity), material});
        if (scene.ground)
            floor = std::min(floor, lowest(loaded, parts.back().field, frame, up));
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

    auto mesh = triangles_of(shapes, parts, grounds, frame,
                             scene.occlusion.method && scene.occlusion.method->needs_mesh);
    AnyField field = united(parts);
    std::vector<Vec3d> points;
    if (!parts.empty())
        points = outline(field, frame).points;
    BuiltScene built{
        .renderable = {std::move(field), frame, box, std::move(parts), std::move(grounds), std::move(mesh)},
        .points = std::move(points),
        .radius = radius};
    const bool several =
        shapes.size() > 1 || std::any_of(shapes.begin(), shapes.end(),
                                         [](const LoadedShape& loaded) { return !loaded.parts.empty(); });
    for_each_shape(shapes, [&](const LoadedShape& loaded) {
        for (const std::string& warning : loaded.warnings)
            built.warnings.push_back(several ? loaded.object->name + ": " + warning : warning);
        if (loaded.stack.levels.empty())
            return;
        built.levels = std::max(built.levels, loaded.stack.levels.size());
        built.voxel = std::max(built.voxel, voxel_of(loaded));
    });
    return built;
}

/// Of an estimator that traces rays: with the samples of a pixel, what a vertex of a bake has.
constexpr double rays_a_sample = 16.0;

RenderOptions rendering_of(const Scene& scene, const BuiltScene& built, const Camera& camera,
                           PassSet passes) {
    RenderOptions options{.samples = scene.samples,
                          .method = scene.occlusion.method,
                          .settings = {built.radius, scene.occlusion.parameters},
                          .image_method = scene.occlusion.image_method,
                          .lighting = studio_lighting(camera, scene.camera.up),
                          .shadow = scene.light.shadow,
                          .casts_shadow = scene.light.casts_shadow,
                          .passes = passes};
    options.lighting.use = scene.occlusion.use;
    if (scene.occlusion.far_samples && options.method && options.method->has_parameter("samples"))
        options.fewer =
            FewerSamples{*scene.occlusion.far_samples,
                         static_cast<float>(scene.occlusion.far / built.renderable.frame.diagonal)};
    if (options.method)
        for (const ParameterInfo& parameter : options.method->parameters())
            if (parameter.name == "rays" && parameter.standard > rays_a_sample)
                options.settings.parameters.emplace(options.settings.parameters.begin(), "rays",
                                                    rays_a_sample);
    // A plane without an end is near probes however far they are.
    if (!built.renderable.grounds.empty())
        options.settings.max_probe_distance = 100.0f;
    const SceneLight& light = scene.light;
    options.lighting.toward_key =
        light.toward_sun ? Vec3(glm::normalize(*light.toward_sun)) : options.lighting.toward_key;
    options.lighting.key = light.sun.value_or(options.lighting.key);
    options.lighting.sky = light.sky.value_or(options.lighting.sky);
    options.lighting.ground = light.bounce.value_or(options.lighting.ground);
    return options;
}

}
