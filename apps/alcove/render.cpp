#include "common.h"
#include "image_output.h"
#include "scene_options.h"
#include "time_estimate.h"

#include "alcove/base/detail/memory.h"
#include "alcove/render/detail/turntable.h"
#include "alcove/scene/build.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>

namespace alcove::cli {
namespace {

struct Options {
    CommonOptions common;
    SceneRequest scene;
    ImageRequest image;
    std::optional<int> frames;
};

/// A picture to draw: where the camera is on its way around, and the file it goes to.
struct Frame {
    double degrees;
    std::string file;
};

/// The frames of a turntable that are not there yet, or the one picture.
std::vector<Frame> frames_to_draw(const Options& options, const ImageOutput& output) {
    if (!options.frames)
        return {{0.0, options.image.file}};
    std::vector<Frame> left;
    for (int i = 0; i < *options.frames; ++i) {
        const std::string file = output.frame_file(i + 1, *options.frames);
        if (!std::filesystem::exists(file))
            left.push_back({360.0 * i / *options.frames, file});
    }
    return left;
}

/// The axis of a turntable: upward through what is looked at.
Axis axis_of(const Scene& scene, const BuiltScene& built) {
    return {scene.camera.look_at.value_or(built.renderable.box.empty() ? Vec3d(0.0)
                                                                       : built.renderable.box.center()),
            scene.camera.up};
}

Camera camera_of(const Options& options, const Scene& scene, const BuiltScene& built, ImageSize size) {
    if (!options.frames || scene.camera.eye)
        return make_camera(scene.camera, built.points, size);
    return make_camera(scene.camera, swept(built.points, axis_of(scene, built)), size);
}

nlohmann::ordered_json triple(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

void run(const Options& options) {
    const ThreadLimit limit(options.common.threads);
    Stopwatch watch;
    nlohmann::ordered_json seconds;
    const ImageOutput output(options.image);
    const Scene scene = requested_scene(options.scene, output.passes());
    const std::string_view method = scene.occlusion.info() ? scene.occlusion.info()->name : "none";
    const std::vector<Frame> frames = frames_to_draw(options, output);
    const int skipped = options.frames ? *options.frames - static_cast<int>(frames.size()) : 0;
    if (frames.empty()) {
        if (options.common.json)
            print_json({{"output", options.image.file}, {"frames", *options.frames}, {"skipped", skipped}});
        else if (!options.common.quiet)
            fmt::print("{}: all {} frames are there; delete those to draw anew\n", options.image.file,
                       skipped);
        return;
    }

    const BuiltScene built = [&] {
        ProgressMeter voxelizing(options.common.progress_mode(), "voxelizing");
        return build_scene(scene, output.passes(), std::ref(voxelizing));
    }();
    seconds["scene"] = watch.lap();

    const double radius = built.radius * built.renderable.frame.diagonal;
    const std::string comments = fmt::format(
        "{}, ambient occlusion: {}, radius {:.6g}, voxel {:.6g} scene units",
        std::filesystem::path(options.scene.input).filename().string(), method, radius, built.voxel);
    const Camera start = camera_of(options, scene, built, scene.size);
    refuse_late_picture(scene.size, [&](ImageSize size) {
        const Camera camera = camera_of(options, scene, built, size);
        render(built.renderable, camera, rendering_of(scene, built, camera, output.passes()));
    });
    double rendering = 0.0, writing = 0.0;
    std::size_t covered = 0;
    {
        ProgressMeter meter(options.common.progress_mode(), "rendering");
        for (std::size_t i = 0; i < frames.size(); ++i) {
            const Camera camera =
                options.frames ? turned(start, axis_of(scene, built), frames[i].degrees) : start;
            const auto done = [&](double part) {
                meter((static_cast<double>(i) + part) / static_cast<double>(frames.size()));
            };
            const Image image =
                render(built.renderable, camera, rendering_of(scene, built, camera, output.passes()), done);
            rendering += watch.lap();
            output.write(image, frames[i].file, camera, comments);
            writing += watch.lap();
            covered += static_cast<std::size_t>(
                std::count_if(image.alpha.begin(), image.alpha.end(), [](float a) { return a > 0.0f; }));
        }
    }
    seconds["render"] = rendering;
    seconds["write"] = writing;

    std::vector<std::string> warnings = built.warnings;
    if (covered == 0)
        warnings.push_back(
            "the picture is empty: the camera does not see the renderable; leave out its eye and "
            "what it looks at");
    const Renderable& renderable = built.renderable;
    if (!two_sided(renderable.field) && renderable.field.map(renderable.frame.to_unit(start.eye())) < 0.0f)
        warnings.push_back("the camera is inside a solid, where all is black: move it, or say sign = "
                           "\"unsigned\" of a room");
    print_warnings(warnings, options.common);
    if (!options.common.json && !options.common.quiet) {
        const std::string drawn =
            options.frames ? fmt::format("{} frames to {}, {} were there", frames.size(),
                                         output.frame_file(*options.frames, *options.frames), skipped)
                           : options.image.file;
        fmt::print("{}: {}x{} pixels, occlusion by {}, radius {:.4g}, voxel {:.4g}\n", drawn,
                   scene.size.width, scene.size.height, method, radius, built.voxel);
    }
    if (options.common.json) {
        nlohmann::ordered_json result{{"input", options.scene.input},
                                      {"output", options.image.file},
                                      {"width", scene.size.width},
                                      {"height", scene.size.height},
                                      {"covered_pixels", covered},
                                      {"method", method},
                                      {"radius", radius},
                                      {"voxel", built.voxel},
                                      {"levels", built.levels},
                                      {"camera",
                                       {{"eye", triple(start.eye())},
                                        {"forward", triple(start.forward())},
                                        {"up", triple(start.up())},
                                        {"fov", start.fov()}}},
                                      {"seconds", seconds},
                                      {"peak_rss_bytes", peak_resident_bytes()},
                                      {"warnings", warnings}};
        if (options.frames) {
            result["frames"] = *options.frames;
            result["skipped"] = skipped;
        }
        print_json(result);
    }
}

}

void add_render(CLI::App& program) {
    auto* verb = program.add_subcommand("render", "Draw a scene, mesh or level set with ambient occlusion");
    auto options = std::make_shared<Options>();
    add_scene_options(*verb, options->scene);
    add_image_options(*verb, options->image);
    verb->add_option("--frames", options->frames,
                     "Once around what is looked at, in N pictures numbered before the extension; those that "
                     "are there "
                     "already are left as they are")
        ->type_name("N")
        ->check(CLI::Range(1, 100000));
    add_common_options(*verb, options->common);
    verb->footer("Examples:\n"
                 "  alcove render scan.ply -o scan.png\n"
                 "  alcove render scene.toml -o scene.png --size 960x540 --method classic\n"
                 "  alcove render scan.vdb -o scan.exr --size 1920x1080 --eye 1,1,3 --look-at 0,0,0\n"
                 "  alcove render scan.ply -o spin.png --frames 36\n");
    verb->callback([options] { run(*options); });
}

}
