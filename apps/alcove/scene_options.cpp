#include "scene_options.h"

#include "weld.h"

#include "alcove/base/detail/limits.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"
#include "alcove/render/detail/image_method.h"
#include "alcove/render/image.h"
#include "alcove/scene/scene.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <charconv>

namespace alcove::cli {
namespace {

ImageSize parse_size(const std::string& text) {
    const char* const end = text.data() + text.size();
    ImageSize size;
    const auto [middle, bad_width] = std::from_chars(text.data(), end, size.width);
    const bool separated = middle != end && (*middle == 'x' || *middle == 'X');
    const auto [last, bad_height] = std::from_chars(separated ? middle + 1 : end, end, size.height);
    if (bad_width != std::errc{} || bad_height != std::errc{} || !separated || last != end || size.width < 1 ||
        size.height < 1)
        throw UsageError(fmt::format("--size takes a width and a height from 1 to {} pixels, not '{}': write "
                                     "--size 1280x720",
                                     longest_side, text));
    return size;
}

void check_size(const Scene& scene, PassSet passes) {
    const ImageSize& size = scene.size;
    const ImageMethod* const method = scene.occlusion.image_method;
    // The image takes memory, and so do the buffers of an image method or, later, the encoded image.
    const double image_bytes = Image::bytes_per_pixel(passes);
    const double bytes_per_pixel = image_bytes + std::max(image_bytes, method ? method->bytes_per_pixel : 0.0);
    const double bytes = bytes_per_pixel * size.width * size.height;
    if (bytes > memory_limit() || std::max(size.width, size.height) > longest_side)
        throw UsageError(fmt::format("an image of {}x{} pixels takes about {:.3g} GB; the limits are {} and {} "
                                     "pixels per side: use a smaller --size, or raise --max-memory",
                                     size.width, size.height, bytes / 1e9, bytes_text(memory_limit()), longest_side));
}

void aim(const SceneRequest& request, CameraOptions& camera) {
    if (request.eye)
        camera.eye = request.eye;
    if (request.look_at)
        camera.look_at = request.look_at;
    camera.up = request.up.value_or(camera.up);
    camera.fov = request.fov.value_or(camera.fov);
    if (camera.eye && camera.look_at && *camera.eye == *camera.look_at)
        throw UsageError("--eye and --look-at are the same point: move one of them");
    if (!(camera.fov >= 1.0 && camera.fov <= 170.0))
        throw UsageError(fmt::format("--fov takes 1 to 170 degrees across the image, not {}", camera.fov));
}

void choose_occlusion(const SceneRequest& request, SceneOcclusion& occlusion) {
    occlusion.radius = request.radius.value_or(occlusion.radius);
    if (request.quality)
        occlusion.choose(*request.quality);
    if (!request.method.method.empty())
        occlusion.choose(request.method.method);
    if (!occlusion.info())
        return;
    // The later of two settings for the same parameter wins.
    Settings given{.parameters = request.method.parameters};
    if (request.method.seed)
        given.parameters.emplace_back("seed", *request.method.seed);
    check_settings(*occlusion.info(), given);
    for (auto& setting : given.parameters)
        occlusion.parameters.push_back(std::move(setting));
}

}

void add_scene_options(CLI::App& verb, SceneRequest& request) {
    verb.add_option("input", request.input,
                    "Scene (toml), mesh (ply, obj, off, stl, glb, gltf) or level set (vdb) to draw")
        ->required();
    verb.add_option("--size", request.size, "Image size in pixels")->type_name("WxH")->default_str("1280x720");
    verb.add_option("--pixel-samples", request.pixel_samples, "Samples (camera rays) per pixel")
        ->type_name("N")
        ->check(CLI::Range(1, 1024))
        ->default_str("4");
    verb.add_option_function<std::string>(
            "--radius", [&request](const std::string& text) { request.radius = Length(text); },
            "Maximum distance of occluders: 0.2 (scene units), 10% (of the diagonal), or inf")
        ->check(parsable([](const std::string& text) { return Length(text); }))
        ->type_name("LEN")
        ->default_str("10%");
    CLI::Option* quality = add_choice<std::optional<Quality>>(
        verb, "--quality", request.quality,
        {{"draft", Quality::draft}, {"good", Quality::good}, {"fine", Quality::fine}},
        "Quality of the default method (guided): draft, good or fine. Sets the number of rays");
    quality->type_name("NAME")->default_str("good");
    add_method_options(verb, request.method,
                       "Method to use: none (no ao), march_steps or screen_space (not available in bake), or one of: ");
    verb.get_option("--method")->excludes(quality);
    verb.get_option("--rays")->description(
        "Occlusion rays per pixel sample, for methods that trace rays (default for traced and exact: 16)");
    add_triple(verb, "--eye", request.eye, Triple::point,
               "Position of the camera; default: chosen so that everything is in view");
    add_triple(verb, "--look-at", request.look_at, Triple::point,
               "Point that the camera looks at; default: the centre of the scene");
    add_triple(verb, "--up", request.up, Triple::direction, "Up direction")->default_str("0,1,0");
    verb.add_option("--fov", request.fov, "Horizontal field of view in degrees")->type_name("DEG")->default_str("40");
    verb.add_flag("--no-ground", request.no_ground, "Leave out the plane through the lowest point");
    verb.add_flag("--no-shadow", request.no_shadow, "Sunlight casts no shadows");
    add_grid_options(verb, request.voxel, request.sign);
    add_grid_names(verb, request.grid_names);
    add_weld_option(verb, request.weld);
    add_choice<std::optional<bool>>(
        verb, "--normals", request.own_normals, {{"field", false}, {"mesh", true}},
        "Normals. mesh: those of the triangles, smoothed except at sharp edges; field: those of the level set")
        ->type_name("NAME")
        ->default_str("mesh");
    add_choice<std::optional<bool>>(
        verb, "--color", request.own_colors, {{"own", true}, {"none", false}},
        "Colours. own: the vertex or face colours of the mesh, or the material colours of an obj; none: grey")
        ->type_name("NAME")
        ->default_str("own");
    verb.add_option("--texture", request.texture, "Texture map (png, exr) to apply to the mesh through its UVs")
        ->type_name("FILE");
}

Scene requested_scene(const SceneRequest& request, PassSet passes) {
    const bool described = extension(request.input) == ".toml";
    Scene scene = described ? read_scene(request.input) : scene_of(request.input);
    MeshShape* mesh = described ? nullptr : std::get_if<MeshShape>(&scene.objects.front().shape);
    if (mesh) {
        mesh->voxel = request.voxel;
        mesh->weld = request.weld;
        mesh->sign = request.sign;
        mesh->own_normals = request.own_normals.value_or(true);
        mesh->own_colors = request.own_colors.value_or(true);
        mesh->texture = request.texture;
    } else if (request.voxel || request.weld || request.sign != SignChoice::automatic || request.own_normals ||
               request.own_colors || !request.texture.empty()) {
        throw UsageError(
            fmt::format("--voxel, --weld, --sign, --normals, --color and --texture are for meshes: {} is a "
                        "{}",
                        request.input, described ? "scene, whose objects set them" : "grid already"));
    }
    if (GridShape* grid = described ? nullptr : std::get_if<GridShape>(&scene.objects.front().shape))
        grid->names = request.grid_names;
    else if (!request.grid_names.empty())
        throw UsageError(fmt::format("--grid-name is for grids: {} is a {}", request.input,
                                     described ? "scene, whose objects name theirs" : "mesh"));
    if (request.no_ground)
        scene.ground.reset();
    if (request.no_shadow)
        scene.light.casts_shadow = false;
    if (!request.size.empty())
        scene.size = parse_size(request.size);
    scene.samples = request.pixel_samples.value_or(scene.samples);
    as_usage([&] { choose_occlusion(request, scene.occlusion); });
    check_size(scene, passes);
    aim(request, scene.camera);
    return scene;
}

}
