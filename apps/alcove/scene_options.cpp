#include "scene_options.h"

#include "length.h"
#include "vector.h"

#include "alcove/base/errors.h"
#include "alcove/render/image.h"
#include "alcove/scene/scene_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <charconv>

namespace alcove::cli {
namespace {

constexpr double memory_limit = 4e9;

ImageSize parse_size(const std::string& text) {
    const char* const end = text.data() + text.size();
    ImageSize size;
    const auto [middle, bad_width] = std::from_chars(text.data(), end, size.width);
    const bool separated = middle != end && (*middle == 'x' || *middle == 'X');
    const auto [last, bad_height] = std::from_chars(separated ? middle + 1 : end, end, size.height);
    if (bad_width != std::errc{} || bad_height != std::errc{} || !separated || last != end ||
        size.width < 1 || size.height < 1)
        throw UsageError(fmt::format("--size takes a width and a height from 1 to {} pixels, not '{}': write "
                                     "--size 1280x720",
                                     longest_side, text));
    return size;
}

void check_size(const Scene& scene, PassSet passes) {
    const ImageSize& size = scene.size;
    const ImageMethod* const method = scene.occlusion.image_method;
    // Beside the image, what a method of the picture keeps, later its encoded form.
    const double image_bytes = Image::bytes_per_pixel(passes);
    const double bytes_per_pixel =
        image_bytes + std::max(image_bytes, method ? method->bytes_per_pixel : 0.0);
    const double bytes = bytes_per_pixel * size.width * size.height;
    if (bytes > memory_limit || std::max(size.width, size.height) > longest_side)
        throw UsageError(
            fmt::format("a picture of {}x{} pixels takes about {:.3g} GB; the limits are {:.0f} GB and {} "
                        "pixels a side: set a smaller --size",
                        size.width, size.height, bytes / 1e9, memory_limit / 1e9, longest_side));
}

void aim(const SceneRequest& request, CameraOptions& camera) {
    if (!request.eye.empty())
        camera.eye = parse_vector(request.eye, "--eye");
    if (!request.look_at.empty())
        camera.look_at = parse_vector(request.look_at, "--look-at");
    if (!request.up.empty())
        camera.up = parse_direction(request.up, "--up");
    camera.fov = request.fov.value_or(camera.fov);
    if (camera.eye && camera.look_at && *camera.eye == *camera.look_at)
        throw UsageError("--eye and --look-at are the same point: move one of them");
    if (!(camera.fov >= 1.0 && camera.fov <= 170.0))
        throw UsageError(fmt::format("--fov takes 1 to 170 degrees across the image, not {}", camera.fov));
}

void choose_occlusion(const SceneRequest& request, SceneOcclusion& occlusion) {
    if (request.radius_given)
        occlusion.radius = parse_length(request.grid.radius, "--radius");
    if (request.method_given)
        try {
            occlusion.choose(request.method.method);
        } catch (const InputError& unknown) {
            throw UsageError(unknown.what());
        }
    if (!occlusion.info())
        return;
    // Of two settings the later holds.
    for (auto& setting : parse_settings(request.method, *occlusion.info()).parameters)
        occlusion.parameters.push_back(std::move(setting));
}

}

void add_scene_options(CLI::App& verb, SceneRequest& request) {
    verb.add_option("input", request.input,
                    "Scene (toml), mesh (ply, obj, off, stl) or level set (vdb) to draw")
        ->required();
    verb.add_option("--size", request.size, "Pixels")->type_name("WxH")->default_str("1280x720");
    verb.add_option("--pixel-samples", request.pixel_samples, "Rays a pixel")
        ->type_name("N")
        ->check(CLI::Range(1, 1024))
        ->default_str("4");
    add_radius_option(verb, request.grid,
                      "How far occluders count: 0.2 (scene units), 10% (of the diagonal), inf");
    add_method_options(verb, request.method,
                       "Estimator, march_steps or screen_space of the picture itself, or none: ");
    verb.get_option("--rays")->description(
        "Rays a sample of a pixel, for methods that trace (traced and exact: 16)");
    verb.add_option("--eye", request.eye, "Where the camera is; default: where it sees all")
        ->type_name("X,Y,Z");
    verb.add_option("--look-at", request.look_at, "What it looks at; default: the middle")
        ->type_name("X,Y,Z");
    verb.add_option("--up", request.up, "Which way is up")->type_name("X,Y,Z")->default_str("0,1,0");
    verb.add_option("--fov", request.fov, "Degrees across the width")->type_name("DEG")->default_str("40");
    verb.add_flag("--no-ground", request.no_ground, "Without the plane below the lowest point");
    verb.add_flag("--no-shadow", request.no_shadow, "The sun shines through everything");
    add_grid_options(verb, request.grid);
    verb.add_option_function<std::string>(
            "--normals",
            [&request](const std::string& source) {
                if (source != "field" && source != "mesh")
                    throw UsageError(fmt::format("--normals takes field or mesh, not '{}'", source));
                request.own_normals = source == "mesh";
            },
            "mesh: smooth but for edges; field: as the level set is")
        ->type_name("NAME")
        ->default_str("mesh");
    verb.parse_complete_callback([&verb, &request] {
        request.radius_given = verb.count("--radius") > 0;
        request.method_given = verb.count("--method") > 0;
    });
}

Scene requested_scene(const SceneRequest& request, PassSet passes) {
    const bool described = extension(request.input) == ".toml";
    Scene scene = described ? read_scene(request.input) : scene_of(request.input);
    MeshShape* mesh = described ? nullptr : std::get_if<MeshShape>(&scene.objects.front().shape);
    if (mesh) {
        mesh->voxel = parse_voxel(request.grid.voxel);
        mesh->sign = parse_sign(request.grid.sign);
        mesh->own_normals = request.own_normals.value_or(true);
    } else if (request.grid.voxel != "auto" || request.grid.sign != "auto" || request.own_normals) {
        throw UsageError(fmt::format("--voxel, --sign and --normals are for meshes: {} is a {}",
                                     request.input,
                                     described ? "scene, which has them in its objects" : "grid already"));
    }
    if (request.no_ground)
        scene.ground.reset();
    if (request.no_shadow)
        scene.light.casts_shadow = false;
    if (!request.size.empty())
        scene.size = parse_size(request.size);
    scene.samples = request.pixel_samples.value_or(scene.samples);
    choose_occlusion(request, scene.occlusion);
    check_size(scene, passes);
    aim(request, scene.camera);
    return scene;
}

}
