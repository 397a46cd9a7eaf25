#include "alcove/render/detail/image_method.h"
#include "alcove/scene/scene.h"

#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"
#include "alcove/mesh/formats/file_bytes.h"
#include "alcove/mesh/formats/text_encoding.h"
#include "alcove/scene/detail/toml_depth.h"
#include "alcove/scene/detail/toml_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

namespace alcove {
namespace {

constexpr double brightest = 1e4; // largest value of a light; half precision ends at 65,504

using Materials = std::map<std::string, Material>;

/// Assigns the value if there is one.
template <class T, class V>
void take(T& target, std::optional<V> value) {
    if (value)
        target = std::move(*value);
}

/// A number in [0, 1].
std::optional<float> share(TomlTable& table, std::string_view key) {
    const std::optional<double> value = table.number(key);
    if (value && !(*value >= 0.0 && *value <= 1.0))
        table.fail(key, fmt::format("takes a number from 0 to 1, not {}", *value));
    return value ? std::optional(static_cast<float>(*value)) : std::nullopt;
}

Material read_material(TomlTable table) {
    Material material;
    constexpr double white = 1.0;
    take(material.color, table.color("color", white));
    take(material.edge_color, table.color("edge_color", white));
    take(material.subsurface, table.color("subsurface", brightest));
    take(material.reflection, share(table, "reflection"));
    take(material.occlusion, share(table, "occlusion"));
    table.check_all_read();
    return material;
}

/// The `material` of a table: a name, or an inline table.
Material material_of(TomlTable& table, const Materials& materials) {
    if (!table.has("material"))
        return {};
    if (!table.raw()["material"].is_string())
        return read_material(*table.table("material"));
    const std::string name = *table.text("material");
    const auto found = materials.find(name);
    if (found == materials.end())
        table.fail("material", fmt::format("{0} is not defined: add [material.{0}]", name));
    return found->second;
}

std::optional<Length> length(TomlTable& table, std::string_view key) {
    if (!table.has(key))
        return {};
    if (table.raw()[key].is_number())
        return Length{*table.positive(key), Length::Unit::scene};
    try {
        return Length(*table.text(key));
    } catch (const InputError& error) {
        table.fail(key, error.what());
    }
}

std::filesystem::path file_of(TomlTable& table, const std::filesystem::path& folder) {
    const std::optional<std::string> file = table.text("file");
    if (!file || file->empty())
        table.fail("", fmt::format("{} needs a file: write file = \"scan.ply\"", table.name()));
    return folder / *file;
}

/// The shapes, in the order of `kinds`.
enum class Kind { sphere, box, torus, capsule, plane, mesh, vdb, unite, subtract };
const std::initializer_list<std::string_view> kinds{"sphere", "box", "torus", "capsule",   "plane",
                                                    "mesh",   "vdb", "union", "difference"};

class ObjectReader {
  public:
    ObjectReader(const Materials& materials, std::filesystem::path folder)
        : materials_(materials), folder_(std::move(folder)) {}

    SceneObject read(TomlTable table, const std::string& fallback_name, int depth) const {
        constexpr int deepest = 32;
        if (depth > deepest)
            table.fail("", fmt::format("parts can be nested at most {} deep", deepest));
        const std::optional<std::size_t> kind = table.word("shape", kinds);
        if (!kind)
            table.fail("", fmt::format("{} needs a shape: write shape = \"sphere\", or another of {}", table.name(),
                                       fmt::join(kinds, ", ")));
        SceneObject object;
        object.name = table.text("name").value_or(fmt::format("{} ({})", fallback_name, kinds.begin()[*kind]));
        if (object.name.empty())
            table.fail("name", "must not be empty");
        take(object.placement.translation, table.vector("translate"));
        take(object.placement.rotation, table.vector("rotate"));
        take(object.placement.scale, table.positive("scale"));
        if (depth == 0)
            object.material = material_of(table, materials_);
        object.shape = read_shape(table, static_cast<Kind>(*kind), object.name, depth);
        for (const char* key : {"normals", "painted", "color"})
            if (depth > 0 && table.has(key))
                table.fail(key, "is only for meshes that are objects: parts have no normals or colours of their own");
        if (auto* mesh = std::get_if<MeshShape>(&object.shape); mesh && (depth > 0 || table.has("material")))
            mesh->own_colors = mesh->own_colors.value_or(false);
        table.check_all_read();
        return object;
    }

  private:
    Shape read_shape(TomlTable& table, Kind kind, const std::string& name, int depth) const {
        switch (kind) {
        case Kind::sphere: {
            SphereShape sphere;
            take(sphere.center, table.vector("center"));
            take(sphere.radius, table.positive("radius"));
            return sphere;
        }
        case Kind::box: {
            BoxShape box;
            take(box.center, table.vector("center"));
            take(box.size, table.vector("size"));
            if (!(std::min({box.size.x, box.size.y, box.size.z}) > 0.0))
                table.fail("size", "takes three numbers above 0");
            return box;
        }
        case Kind::torus: {
            TorusShape torus;
            take(torus.center, table.vector("center"));
            take(torus.ring, table.positive("ring"));
            take(torus.tube, table.positive("tube"));
            return torus;
        }
        case Kind::capsule: {
            CapsuleShape capsule;
            take(capsule.start, table.vector("start"));
            take(capsule.end, table.vector("end"));
            take(capsule.radius, table.positive("radius"));
            return capsule;
        }
        case Kind::plane: {
            PlaneShape plane;
            take(plane.point, table.vector("point"));
            take(plane.normal, table.direction("normal"));
            return plane;
        }
        case Kind::mesh: {
            MeshShape mesh{file_of(table, folder_), length(table, "voxel")};
            if (mesh.voxel && (mesh.voxel->unit == Length::Unit::voxels || std::isinf(mesh.voxel->value)))
                table.fail("voxel", "takes a finite length, and not in vx: write 0.2 (scene units) or \"0.5%\"");
            constexpr SignChoice signs[] = {SignChoice::automatic, SignChoice::solid, SignChoice::sheet};
            if (const auto sign = table.word("sign", {"auto", "solid", "sheet"}))
                mesh.sign = signs[*sign];
            mesh.own_normals = table.word("normals", {"field", "mesh"}) != std::size_t{0};
            take(mesh.painted, table.flag("painted"));
            if (const auto colors = table.word("color", {"none", "own"}))
                mesh.own_colors = *colors == 1;
            else if (mesh.painted)
                mesh.own_colors = false;
            if (const std::optional<std::string> texture = table.text("texture"))
                mesh.texture = folder_ / *texture;
            mesh.weld = length(table, "weld");
            if (mesh.weld && (mesh.weld->unit == Length::Unit::voxels || std::isinf(mesh.weld->value)))
                table.fail("weld", "takes a finite length, and not in vx: write 0.2 (scene units) or \"0.001%\"");
            return mesh;
        }
        case Kind::vdb: {
            GridShape grid{file_of(table, folder_)};
            if (std::optional<std::string> wanted = table.text("grid"))
                grid.names.push_back(std::move(*wanted));
            return grid;
        }
        case Kind::unite:
        case Kind::subtract:
            break;
        }
        return read_composite(table, kind == Kind::unite, name, depth);
    }

    CompositeShape read_composite(TomlTable& table, bool unite, const std::string& name, int depth) const {
        using Operation = CompositeShape::Operation;
        CompositeShape composite;
        composite.operation = unite ? Operation::unite : Operation::subtract;
        if (const std::optional<double> width = table.number("blend")) {
            if (!(*width >= 0.0))
                table.fail("blend", "takes a width of 0 or more, in scene units");
            composite.blend = *width;
        }
        for (TomlTable& part : table.tables("part"))
            composite.parts.push_back(
                read(std::move(part), fmt::format("{}, part {}", name, composite.parts.size() + 1), depth + 1));
        if (composite.parts.empty())
            table.fail("", fmt::format("{} needs parts: add an [[object.part]] below it for each", table.name()));
        return composite;
    }

    const Materials& materials_;
    std::filesystem::path folder_;
};

/// Checks a parameter of a method. \throw InputError at the key if the method does not have the parameter or the value
/// is out of range.
void check_parameter(const TomlTable& table, std::string_view key, const MethodInfo& method,
                     const std::pair<std::string, double>& parameter) {
    try {
        check_settings(method, {.parameters = {parameter}});
    } catch (const InputError& wrong) {
        table.fail(key, wrong.what(), ": ");
    }
}

void read_occlusion(TomlTable table, SceneOcclusion& occlusion) {
    if (const std::optional<std::string> name = table.text("method")) {
        try {
            occlusion.choose(*name);
        } catch (const InputError& unknown) {
            table.fail("method", unknown.what(), ": ");
        }
    }
    take(occlusion.radius, length(table, "radius"));
    constexpr OcclusionUse uses[] = {OcclusionUse::sky, OcclusionUse::ambient, OcclusionUse::everything};
    if (const auto use = table.word("light", {"sky", "ambient", "everything"}))
        occlusion.use = uses[*use];
    occlusion.far_samples = table.count("far_samples", 1, 1 << 20);
    take(occlusion.far, table.positive("far"));
    if (occlusion.far_samples.has_value() != (occlusion.far > 0.0))
        table.fail(occlusion.far_samples ? "far_samples" : "far",
                   "needs both keys: write far_samples = 2 and far = 50 (a distance from the camera)");
    if (occlusion.far_samples && !(occlusion.method && occlusion.method->samples_are == SampleKind::probes))
        table.fail("far_samples", "is only for methods that take samples, such as classic");
    if (occlusion.far_samples)
        check_parameter(table, "far_samples", *occlusion.method,
                        {"samples", static_cast<double>(*occlusion.far_samples)});
    if (const MethodInfo* method = occlusion.info())
        for (const ParameterInfo& parameter : method->parameters()) {
            const std::optional<double> value =
                parameter.flag ? table.flag(parameter.name) : table.number(parameter.name);
            if (!value)
                continue;
            occlusion.parameters.emplace_back(parameter.name, *value);
            check_parameter(table, parameter.name, *method, occlusion.parameters.back());
        }
    table.check_all_read();
}

void read_camera(TomlTable table, CameraOptions& camera) {
    take(camera.eye, table.vector("eye"));
    take(camera.look_at, table.vector("look_at"));
    take(camera.up, table.direction("up"));
    if (const std::optional<double> fov = table.number("fov")) {
        if (!(*fov >= 1.0 && *fov <= 170.0))
            table.fail("fov", fmt::format("takes 1 to 170 degrees across the image, not {}", *fov));
        camera.fov = *fov;
    }
    if (camera.eye && camera.look_at && *camera.eye == *camera.look_at)
        table.fail("look_at", "is the same point as eye: move one of them");
    table.check_all_read();
}

void read_image(TomlTable table, Scene& scene) {
    take(scene.size.width, table.count("width", 1, longest_side));
    take(scene.size.height, table.count("height", 1, longest_side));
    take(scene.samples, table.count("samples", 1, 1024));
    table.check_all_read();
}

Scene read_tables(TomlTable table, const std::filesystem::path& folder) {
    Scene scene;
    Materials materials;
    if (std::optional<TomlTable> named = table.table("material"))
        for (auto& [name, material] : named->named_tables())
            materials.emplace(name, read_material(std::move(material)));
    const ObjectReader objects(materials, folder);
    for (TomlTable& object : table.tables("object"))
        scene.objects.push_back(objects.read(std::move(object), fmt::format("object {}", scene.objects.size() + 1), 0));
    if (std::optional<TomlTable> ground = table.table("ground")) {
        scene.ground = SceneGround{material_of(*ground, materials), ground->number("height")};
        ground->check_all_read();
    }
    if (std::optional<TomlTable> sun = table.table("sun")) {
        take(scene.light.toward_sun, sun->direction("direction"));
        take(scene.light.sun, sun->color("color", brightest));
        take(scene.light.casts_shadow, sun->flag("shadow"));
        take(scene.light.shadow.sharpness, sun->positive("sharpness"));
        sun->check_all_read();
    }
    if (std::optional<TomlTable> sky = table.table("sky")) {
        take(scene.light.sky, sky->color("color", brightest));
        take(scene.light.bounce, sky->color("bounce", brightest));
        sky->check_all_read();
    }
    if (std::optional<TomlTable> occlusion = table.table("occlusion"))
        read_occlusion(std::move(*occlusion), scene.occlusion);
    if (std::optional<TomlTable> camera = table.table("camera"))
        read_camera(std::move(*camera), scene.camera);
    if (std::optional<TomlTable> image = table.table("image"))
        read_image(std::move(*image), scene);
    table.check_all_read();
    return scene;
}

}

Scene read_scene(const std::filesystem::path& file) {
    const FileBytes bytes(file);
    refuse_wide_text(bytes);
    check_toml_depth(bytes);
    try {
        const toml::table root = toml::parse(without_byte_order_mark(bytes.view()), file.string());
        return read_tables(TomlTable(root, file.string(), "the scene"), file.parent_path());
    } catch (const toml::parse_error& error) {
        throw InputError(fmt::format("{}:{}: invalid TOML: {}", file.string(), error.source().begin.line,
                                     in_one_line(std::string(error.description()))));
    }
}

}
