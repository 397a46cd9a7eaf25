#include "common.h"
#include "scene_options.h"

#include "alcove/atomic_file.h"
#include "alcove/resident_memory.h"
#include "alcove/scene/staging.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>

namespace alcove::cli {
namespace {

struct Options {
    CommonOptions common;
    SceneRequest scene;
    std::string output;
    std::vector<std::string> passes;
    std::string precision = "half";
};

/// The passes that are wanted: those that are named, `all`, or the standard ones. \throw UsageError for an unknown one.
PassSet parse_passes(const std::vector<std::string>& names) {
    PassSet wanted;
    for (const std::string& name : names) {
        bool known = false;
        for (const PassInfo& info : all_passes)
            if (name == info.name || name == "all") {
                wanted = wanted | info.pass;
                known = true;
            }
        if (!known) {
            std::vector<std::string_view> all;
            for (const PassInfo& info : all_passes)
                all.push_back(info.name);
            throw UsageError(
                fmt::format("there is no pass '{}'; there are: {}, all", name, fmt::join(all, ", ")));
        }
    }
    return wanted;
}

Precision parse_precision(const std::string& name) {
    if (name != "half" && name != "float")
        throw UsageError(fmt::format("--precision takes half or float, not '{}'", name));
    return name == "half" ? Precision::half : Precision::single;
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
    const bool png = format == ".png";
    const PassSet named = parse_passes(options.passes);
    const PassSet wanted = !named.empty() ? named : png ? PassSet(Pass::beauty) : standard_passes;
    const auto shown = std::find_if(all_passes.begin(), all_passes.end(),
                                    [&](const PassInfo& info) { return wanted.has(info.pass); });
    if (png && wanted != shown->pass)
        throw UsageError("a .png shows one pass: give --pass once, or write an .exr, which holds all");
    const Precision precision = parse_precision(options.precision);
    const Scene scene = requested_scene(options.scene, wanted);
    const std::string_view method = scene.occlusion.info() ? scene.occlusion.info()->name : "none";

    const Staged staged = [&] {
        ProgressMeter voxelizing(options.common.progress_mode(), "voxelizing");
        return stage(scene, wanted, std::ref(voxelizing));
    }();
    seconds["scene"] = watch.lap();

    const Camera camera = make_camera(scene.camera, staged.points, scene.size);
    Image image;
    {
        ProgressMeter drawing(options.common.progress_mode(), "rendering");
        image =
            render(staged.subject, camera, rendering_of(scene, staged, camera, wanted), std::ref(drawing));
    }
    seconds["render"] = watch.lap();

    const double radius = staged.radius * staged.subject.frame.diagonal;
    if (png) {
        write_png(image, options.output, shown->pass);
    } else {
        ImageHeader header;
        header.world_to_camera = camera.world_to_camera();
        header.world_to_ndc = camera.world_to_ndc();
        header.screen_window_width = camera.screen_window_width();
        header.software = "alcove " ALCOVE_VERSION;
        header.comments = fmt::format("{}, ambient occlusion: {}, radius {:.6g}, voxel {:.6g} scene units",
                                      std::filesystem::path(options.scene.input).filename().string(), method,
                                      radius, staged.voxel);
        write_exr(image, options.output, header, precision);
    }
    seconds["write"] = watch.lap();

    std::vector<std::string> warnings = staged.warnings;
    const auto covered =
        std::count_if(image.alpha.begin(), image.alpha.end(), [](float a) { return a > 0.0f; });
    if (covered == 0)
        warnings.push_back(
            "the picture is empty: the camera does not see the subject; leave out --eye and --look-at");
    print_warnings(warnings, options.common);
    if (!options.common.json && !options.common.quiet)
        fmt::print("{}: {}x{} pixels, occlusion by {}, radius {:.4g}, voxel {:.4g}\n", options.output,
                   scene.size.width, scene.size.height, method, radius, staged.voxel);
    if (options.common.json)
        print_json({{"input", options.scene.input},
                    {"output", options.output},
                    {"width", scene.size.width},
                    {"height", scene.size.height},
                    {"covered_pixels", covered},
                    {"method", method},
                    {"radius", radius},
                    {"voxel", staged.voxel},
                    {"levels", staged.levels},
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
    auto* verb = program.add_subcommand("render", "Draw a scene, mesh or level set with ambient occlusion");
    auto options = std::make_shared<Options>();
    add_scene_options(*verb, options->scene);
    verb->add_option("-o,--output", options->output, "Image to write (exr, or png of one pass)")->required();
    verb->add_option(
            "--pass", options->passes,
            "What the image shows: beauty, ao, depth, normal (of an exr, these four by default), position, "
            "convexity, shadow, steps, object, or all; a png shows one. Give it again for more")
        ->option_text("NAME");
    verb->add_option("--precision", options->precision, "Of the colours of an exr: half or float")
        ->type_name("NAME")
        ->capture_default_str();
    add_common_options(*verb, options->common);
    verb->footer("Examples:\n"
                 "  alcove render scan.ply -o scan.png\n"
                 "  alcove render scene.toml -o scene.png --size 960x540 --method classic\n"
                 "  alcove render scan.vdb -o scan.exr --size 1920x1080 --eye 1,1,3 --look-at 0,0,0\n");
    verb->callback([options] { run(*options); });
}

}
