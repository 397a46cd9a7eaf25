#include "ending.h"
#include "image_output.h"
#include "options.h"
#include "scene_options.h"

#include "alcove/bake/detail/deadline.h"
#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/stopwatch.h"
#include "alcove/base/parallel.h"
#include "alcove/render/detail/image_method.h"
#include "alcove/render/detail/turntable.h"
#include "alcove/scene/scene.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
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

/// An image to render: the angle of the camera on the turntable, and the file to write.
struct Frame {
    double degrees;
    std::string file;
};

/// The frames of a turntable whose files do not exist yet, or the single image.
std::vector<Frame> frames_to_draw(const Options& options, const ImageOutput& output) {
    if (!options.frames)
        return {{0.0, options.image.file}};
    std::vector<Frame> left;
    std::error_code unknown;
    for (int i = 0; i < *options.frames; ++i) {
        const std::string file = output.frame_file(i + 1, *options.frames);
        if (!std::filesystem::exists(file, unknown))
            left.push_back({360.0 * i / *options.frames, file});
    }
    return left;
}

/// The axis of a turntable: the up direction through the point that the camera looks at.
Axis axis_of(const Scene& scene, const BuiltScene& built) {
    return {scene.camera.look_at.value_or(built.renderable.box.empty() ? Vec3d(0.0) : built.renderable.box.center()),
            scene.camera.up};
}

Camera camera_of(const Options& options, const Scene& scene, const BuiltScene& built, ImageSize size) {
    if (!options.frames || scene.camera.eye)
        return make_camera(scene.camera, built.points, size);
    return make_camera(scene.camera, swept(built.points, axis_of(scene, built)), size);
}

/// Refuses an image that would clearly exceed the time limit. `draw` renders an image of a size that it is given. The
/// time is estimated from two images, with 1/16 and 1/64 of the width and height.
void check_time(ImageSize size, const std::function<void(ImageSize)>& draw) {
    const Deadline deadline(seconds_left());
    if (!deadline.is_set())
        return;
    const auto pixels = [](const ImageSize& of) { return static_cast<double>(of.width) * of.height; };
    const auto scaled = [&](double by) {
        return ImageSize{std::max(static_cast<int>(by * size.width), 1),
                         std::max(static_cast<int>(by * size.height), 1)};
    };
    // The difference between the two times excludes work whose time does not depend on the size.
    const ImageSize small = scaled(1.0 / 16.0), smaller = scaled(1.0 / 64.0);
    const double less = shared_seconds_of([&] { draw(smaller); });
    const double more = shared_seconds_of([&] { draw(small); });
    const double per_pixel = (more - less) / std::max(pixels(small) - pixels(smaller), 1.0);
    deadline.check(per_pixel * pixels(size), [&](double share) -> std::string {
        constexpr double least_side = 0.1;
        const double side = std::sqrt(share);
        if (side < least_side)
            return "fewer samples and a smaller --size";
        const ImageSize fits = scaled(side);
        return fmt::format("--size {}x{}", fits.width, fits.height);
    });
}

nlohmann::ordered_json triple(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

std::string_view name_of_method(const Scene& scene, const BuiltScene& built) {
    const ImageMethod* const image_method = scene.occlusion.image_method;
    return built.occlusion.method ? built.occlusion.method->name : image_method ? image_method->name : "none";
}

/// One run of the verb, from reading the scene to printing the result.
class RenderJob {
  public:
    explicit RenderJob(const Options& options)
        : options_(options), output_(options.image), scene_(requested_scene(options.scene, output_.passes())),
          frames_(frames_to_draw(options, output_)) {}

    void run() {
        if (frames_.empty()) {
            if (options_.common.json)
                print_json({{"output", options_.image.file}, {"frames", *options_.frames}, {"skipped", skipped()}});
            else if (!options_.common.quiet)
                say(fmt::format("{}: all {} frames exist; delete the ones to render again", options_.image.file,
                                skipped()));
            return;
        }
        Stopwatch watch;
        const BuiltScene built = [&] {
            ProgressMeter voxelizing(options_.common.progress_mode(), "voxelizing");
            return build_scene(scene_, output_.passes(), std::ref(voxelizing));
        }();
        seconds_["scene"] = watch.lap();
        const Camera start = camera_of(options_, scene_, built, scene_.size);
        check_time(scene_.size, [&](ImageSize size) {
            const Camera camera = camera_of(options_, scene_, built, size);
            render(built.renderable, camera, rendering_of(scene_, built, camera, output_.passes()));
        });
        draw(built, start);
        const std::vector<std::string> warnings = warnings_of(built, start);
        print_warnings(warnings, options_.common);
        if (options_.common.json)
            print_object(built, start, warnings);
        else if (!options_.common.quiet)
            print_line(built);
    }

  private:
    int skipped() const { return options_.frames ? *options_.frames - static_cast<int>(frames_.size()) : 0; }
    double radius_of(const BuiltScene& built) const { return built.radius * built.renderable.frame.diagonal; }

    void draw(const BuiltScene& built, const Camera& start) {
        const std::string comments = fmt::format("{}, ambient occlusion: {}, radius {:.6g}, voxel {:.6g} scene units",
                                                 std::filesystem::path(options_.scene.input).filename().string(),
                                                 name_of_method(scene_, built), radius_of(built), built.voxel);
        ProgressMeter meter(options_.common.progress_mode(), "rendering");
        double rendering = 0.0, writing = 0.0;
        Stopwatch watch;
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            const Camera camera = options_.frames ? turned(start, axis_of(scene_, built), frames_[i].degrees) : start;
            const auto done = [&](double part) {
                meter((static_cast<double>(i) + part) / static_cast<double>(frames_.size()));
            };
            const Image image =
                render(built.renderable, camera, rendering_of(scene_, built, camera, output_.passes()), done);
            rendering += watch.lap();
            output_.write(image, frames_[i].file, camera, comments);
            writing += watch.lap();
            covered_ += static_cast<std::size_t>(
                std::count_if(image.alpha.begin(), image.alpha.end(), [](float a) { return a > 0.0f; }));
        }
        seconds_["render"] = rendering;
        seconds_["write"] = writing;
    }

    std::vector<std::string> warnings_of(const BuiltScene& built, const Camera& start) const {
        std::vector<std::string> warnings = built.warnings;
        if (covered_ == 0)
            warnings.push_back("the image is empty: " + why_empty());
        const Renderable& renderable = built.renderable;
        if (!two_sided(renderable.field) && renderable.field.map(renderable.frame.to_unit(start.eye())) < 0.0f)
            warnings.emplace_back("the camera is inside a solid, where everything is black: move it" + room_fix());
        return warnings;
    }

    std::string why_empty() const {
        if (options_.scene.eye || options_.scene.look_at)
            return "nothing is in front of the camera: leave out --eye and --look-at";
        if (scene_.camera.eye || scene_.camera.look_at)
            return "nothing is in front of the camera: leave out eye and look_at of [camera]";
        return "everything is smaller than a pixel or thinner than a voxel: use a larger --size or a finer voxel, or "
               "aim at a part with --eye and --look-at";
    }

    /// A further fix for the warning to suggest, in case the solid is a room.
    std::string room_fix() const {
        const std::string kind = extension(options_.scene.input);
        return kind == ".vdb"    ? ""
               : kind == ".toml" ? ", or write sign = \"sheet\" for a room"
                                 : ", or use --sign sheet for a room";
    }

    void print_line(const BuiltScene& built) const {
        std::string drawn = frames_.front().file;
        if (options_.frames)
            drawn = fmt::format("wrote {} of {} frames, {}{}", frames_.size(), *options_.frames, drawn,
                                frames_.size() > 1 ? " to " + frames_.back().file : "");
        say(fmt::format("{}: {}x{} pixels, occlusion by {}, radius {:.4g}{}", drawn, scene_.size.width,
                        scene_.size.height, name_of_method(scene_, built), radius_of(built),
                        built.voxel > 0.0 ? fmt::format(", voxel {:.4g}", built.voxel) : ""));
    }

    void print_object(const BuiltScene& built, const Camera& start, const std::vector<std::string>& warnings) const {
        nlohmann::ordered_json result{{"input", options_.scene.input},
                                      {"output", options_.image.file},
                                      {"width", scene_.size.width},
                                      {"height", scene_.size.height},
                                      {"covered_pixels", covered_},
                                      {"method", name_of_method(scene_, built)},
                                      {"radius", radius_of(built)},
                                      {"voxel", built.voxel},
                                      {"levels", built.levels},
                                      {"camera",
                                       {{"eye", triple(start.eye())},
                                        {"forward", triple(start.forward())},
                                        {"up", triple(start.up())},
                                        {"fov", start.fov()}}},
                                      {"seconds", seconds_},
                                      {"peak_rss_bytes", peak_resident_bytes()},
                                      {"warnings", warnings}};
        if (options_.frames) {
            result["frames"] = *options_.frames;
            result["skipped"] = skipped();
        }
        print_json(result);
    }

    const Options& options_;
    ImageOutput output_;
    Scene scene_;
    std::vector<Frame> frames_;
    nlohmann::ordered_json seconds_;
    std::size_t covered_ = 0;
};

void run(const Options& options) {
    const ThreadLimit limit(options.common.threads);
    RenderJob(options).run();
}

}

void add_render(CLI::App& program) {
    auto* verb = program.add_subcommand("render", "Draw a scene, mesh or level set with ambient occlusion");
    auto options = std::make_shared<Options>();
    add_scene_options(*verb, options->scene);
    add_image_options(*verb, options->image);
    verb->add_option(
            "--frames", options->frames,
            "Turntable: N views from around the object; the frame number is inserted before the extension of the "
            "file name, and existing images are not rendered again")
        ->type_name("N")
        ->check(CLI::Range(1, 100000));
    add_common_options(*verb, options->common);
    verb->footer("Examples:\n"
                 "  alcove render scan.ply -o scan.png\n"
                 "  alcove render scene.toml -o scene.png --size 960x540 --method classic\n"
                 "  alcove render scan.vdb -o scan.exr --size 1920x1080 --eye 1,1,3 --look-at 0,0,0\n"
                 "  alcove render scan.ply -o clay.png --color none\n"
                 "  alcove render game.obj -o game.png --texture game_ao.png --method none\n"
                 "  alcove render scan.ply -o spin.png --frames 36\n");
    verb->callback([options] { run(*options); });
}

}
