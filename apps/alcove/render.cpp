#include "common.h"
#include "length.h"
#include "method_options.h"
#include "vector.h"
#include "voxelized.h"

#include "alcove/atomic_file.h"
#include "alcove/errors.h"
#include "alcove/field/level_stack.h"
#include "alcove/grid/grid_io.h"
#include "alcove/render/renderer.h"
#include "alcove/resident_memory.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <memory>

namespace alcove::cli {
namespace {

constexpr double memory_limit = 4e9;

struct Options {
    CommonOptions common;
    GridRequest grid;
    MethodRequest method;
    std::string input, output, size = "1280x720", eye, look_at, up = "0,1,0";
    double fov = CameraOptions{}.fov;
    std::vector<std::string> passes;
};

/// What the camera looks at, and what reading it had to say.
struct Scene {
    Subject subject;
    std::vector<Vec3d> points;
    double voxel;
    std::size_t levels;
    float radius; // unit space
    std::vector<std::string> warnings;
};

Pass parse_pass(const std::string& text) {
    static const std::map<std::string_view, Pass> passes{
        {"beauty", Pass::beauty}, {"ao", Pass::ao}, {"normal", Pass::normal}, {"depth", Pass::depth}};
    const auto found = passes.find(text);
    if (found == passes.end())
        throw UsageError(fmt::format("there is no pass '{}'; there are: beauty, ao, normal, depth", text));
    return found->second;
}

ImageSize parse_size(const std::string& text) {
    const char* const end = text.data() + text.size();
    long long width = 0, height = 0;
    const auto [middle, bad_width] = std::from_chars(text.data(), end, width);
    const bool separated = middle != end && (*middle == 'x' || *middle == 'X');
    const auto [last, bad_height] = std::from_chars(separated ? middle + 1 : end, end, height);
    if (bad_width != std::errc{} || bad_height != std::errc{} || !separated || last != end || width < 1 ||
        height < 1)
        throw UsageError(fmt::format(
            "--size takes a width and a height of at least 1 pixel, not '{}': write --size 1280x720", text));
    // Beside the image, its encoded form is in memory once more.
    const double bytes =
        2.0 * Image::bytes_per_pixel * static_cast<double>(width) * static_cast<double>(height);
    constexpr long long longest = 65536;
    if (bytes > memory_limit || width > longest || height > longest)
        throw UsageError(
            fmt::format("--size {} takes about {:.3g} GB; the limits are {:.0f} GB and {} pixels a side",
                        text, bytes / 1e9, memory_limit / 1e9, longest));
    return {static_cast<int>(width), static_cast<int>(height)};
}

CameraOptions camera_options(const Options& options) {
    CameraOptions camera;
    if (!options.eye.empty())
        camera.eye = parse_vector(options.eye, "--eye");
    if (!options.look_at.empty())
        camera.look_at = parse_vector(options.look_at, "--look-at");
    camera.up = parse_direction(options.up, "--up");
    camera.fov = options.fov;
    if (camera.eye && camera.look_at && *camera.eye == *camera.look_at)
        throw UsageError("--eye and --look-at are the same point: move one of them");
    if (!(camera.fov >= 1.0 && camera.fov <= 170.0))
        throw UsageError(fmt::format("--fov takes 1 to 170 degrees across the image, not {}", camera.fov));
    return camera;
}

Scene scene_of_grid(const Options& options) {
    if (options.grid.voxel != "auto" || options.grid.sign != "auto")
        throw UsageError("--voxel and --sign are for meshes: " + options.input + " is a grid already");
    const Length radius = parse_length(options.grid.radius, "--radius");
    const GridStack stack = read_grids(options.input);
    const LevelStack field(stack);
    try {
        Outline around = outline(field, stack.frame);
        return {{field, stack.frame, around.box},
                std::move(around.points),
                stack.levels.front().voxel * stack.frame.diagonal,
                stack.levels.size(),
                radius.to_unit(stack.frame.diagonal, stack.levels.front().voxel),
                stack.warnings};
    } catch (const InputError& error) {
        throw InputError(options.input + ": " + error.what());
    }
}

Scene scene_of_mesh(const Options& options, nlohmann::ordered_json& seconds) {
    VoxelizedMesh input = read_and_voxelize(options.input, options.grid, options.common, seconds);
    std::vector<Vec3d> points;
    std::copy_if(input.mesh.positions.begin(), input.mesh.positions.end(), std::back_inserter(points),
                 is_finite);
    return {{LevelStack(input.stack), input.frame, input.mesh.box()},
            std::move(points),
            input.stack.levels.front().voxel * input.frame.diagonal,
            input.stack.levels.size(),
            input.radius,
            std::move(input.warnings)};
}

nlohmann::ordered_json triple(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

void run(const Options& options) {
    const ThreadLimit limit(options.common.threads);
    Stopwatch watch;
    nlohmann::ordered_json seconds;
    const std::string format = extension(options.output);
    if (format != ".exr" && format != ".png")
        throw UsageError(
            fmt::format("{}: an image is written as .exr or .png; name the output so", options.output));
    const AtomicFile probe(options.output);
    std::vector<Pass> passes;
    for (const std::string& pass : options.passes)
        passes.push_back(parse_pass(pass));
    if (format == ".png" && passes.size() > 1)
        throw UsageError("a .png shows one pass: give --pass once, or write an .exr, which holds all");
    const ImageSize size = parse_size(options.size);
    const CameraOptions wanted = camera_options(options);
    RenderOptions rendering;
    if (options.method.method != "none") {
        rendering.method = &parse_method(options.method.method);
        if (rendering.method->asks_rays)
            throw UsageError("render draws a field: --method " + options.method.method +
                             " traces the mesh itself; use traced");
        rendering.settings = parse_settings(options.method, *rendering.method, Channel::ao);
    }

    const Scene scene =
        extension(options.input) == ".vdb" ? scene_of_grid(options) : scene_of_mesh(options, seconds);
    watch.lap();

    const Camera camera = make_camera(wanted, scene.points, size);
    rendering.lighting = studio_lighting(camera, wanted.up);
    rendering.settings.radius = scene.radius;
    Image image;
    {
        ProgressMeter drawing(options.common.progress_mode(), "rendering");
        image = render(scene.subject, camera, rendering, std::ref(drawing));
    }
    seconds["render"] = watch.lap();

    const double diagonal = scene.subject.frame.diagonal;
    if (format == ".png") {
        write_png(image, options.output, passes.empty() ? Pass::beauty : passes.front());
    } else {
        ImageHeader header;
        header.world_to_camera = camera.world_to_camera();
        header.world_to_ndc = camera.world_to_ndc();
        header.screen_window_width = camera.screen_window_width();
        header.software = "alcove " ALCOVE_VERSION;
        header.comments = fmt::format("{}, ambient occlusion: {}, radius {:.6g}, voxel {:.6g} scene units",
                                      std::filesystem::path(options.input).filename().string(),
                                      options.method.method, scene.radius * diagonal, scene.voxel);
        write_exr(image, options.output, header);
    }
    seconds["write"] = watch.lap();

    std::vector<std::string> warnings = scene.warnings;
    const auto covered =
        std::count_if(image.alpha.begin(), image.alpha.end(), [](float a) { return a > 0.0f; });
    if (covered == 0)
        warnings.push_back(
            "the picture is empty: the camera does not see the subject; leave out --eye and --look-at");
    print_warnings(warnings, options.common);
    if (!options.common.json && !options.common.quiet)
        fmt::print("{}: {}x{} pixels, occlusion by {}, radius {:.4g}, voxel {:.4g}\n", options.output,
                   size.width, size.height, options.method.method, scene.radius * diagonal, scene.voxel);
    if (options.common.json)
        print_json({{"input", options.input},
                    {"output", options.output},
                    {"width", size.width},
                    {"height", size.height},
                    {"covered_pixels", covered},
                    {"method", options.method.method},
                    {"radius", scene.radius * diagonal},
                    {"voxel", scene.voxel},
                    {"levels", scene.levels},
                    {"camera",
                     {{"eye", triple(camera.eye())},
                      {"forward", triple(camera.forward())},
                      {"up", triple(camera.up())},
                      {"fov", camera.fov()}}},
                    {"seconds", seconds},
                    {"peak_rss_bytes", peak_resident_bytes()},
                    {"warnings", warnings}});
}

}

void add_render(CLI::App& program) {
    auto* verb = program.add_subcommand("render", "Draw a mesh or grid with ambient occlusion");
    auto options = std::make_shared<Options>();
    verb->add_option("input", options->input, "Mesh (ply, obj, off, stl) or grid (vdb) to draw")->required();
    verb->add_option("-o,--output", options->output, "Image to write (exr with all passes, or png)")
        ->required();
    verb->add_option("--size", options->size, "Pixels")->type_name("WxH")->capture_default_str();
    add_radius_option(*verb, options->grid,
                      "How far occluders count: 0.2 (scene units), 10% (of the diagonal), inf");
    add_method_options(*verb, options->method, "Estimator, or none: ");
    verb->add_option("--pass", options->passes, "What a png shows: beauty (default), ao, normal or depth")
        ->option_text("NAME");
    verb->add_option("--eye", options->eye, "Where the camera is; default: where it sees all")
        ->type_name("X,Y,Z");
    verb->add_option("--look-at", options->look_at, "What it looks at; default: the middle")
        ->type_name("X,Y,Z");
    verb->add_option("--up", options->up, "Which way is up")->type_name("X,Y,Z")->capture_default_str();
    verb->add_option("--fov", options->fov, "Degrees across the width")
        ->type_name("DEG")
        ->capture_default_str();
    add_grid_options(*verb, options->grid);
    add_common_options(*verb, options->common);
    verb->footer("Examples:\n"
                 "  alcove render scan.ply -o scan.png\n"
                 "  alcove render scan.vdb -o scan.exr --size 1920x1080 --eye 1,1,3 --look-at 0,0,0\n");
    verb->callback([options] { run(*options); });
}

}
