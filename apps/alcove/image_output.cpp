#include "image_output.h"

#include "options.h"

#include "alcove/base/detail/atomic_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

namespace alcove::cli {
namespace {

/// The passes with these names. \throw UsageError for an unknown name.
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
            all.reserve(all_passes.size());
            for (const PassInfo& info : all_passes)
                all.push_back(info.name);
            throw UsageError(fmt::format("there is no pass '{}'; the passes are: {}, all", name, fmt::join(all, ", ")));
        }
    }
    return wanted;
}

/// The first of the wanted passes, in the order of `all_passes`.
Pass first(PassSet wanted) {
    return std::find_if(all_passes.begin(), all_passes.end(),
                        [&](const PassInfo& info) { return wanted.has(info.pass); })
        ->pass;
}

}

void add_image_options(CLI::App& verb, ImageRequest& request) {
    verb.add_option("-o,--output", request.file, "Image to write (exr, or png of one pass)")->required();
    verb.add_option("--pass", request.passes,
                    "Pass to write: beauty, ao, depth, normal, position, convexity, shadow, steps, object or all. An "
                    "exr gets beauty, ao, depth and normal by default; a png holds one pass. Repeat the option for "
                    "more")
        ->option_text("NAME");
    add_choice<Precision>(verb, "--precision", request.precision,
                          {{"half", Precision::half}, {"float", Precision::single}},
                          "Precision of the colours in an exr: half or float")
        ->type_name("NAME")
        ->default_str("half");
}

ImageOutput::ImageOutput(const ImageRequest& request) : file_(request.file) {
    const std::string format = extension(file_);
    if (format != ".exr" && format != ".png")
        throw UsageError(fmt::format("{}: images are written as .exr or .png: use one of these extensions", file_));
    png_ = format == ".png";
    passes_ = parse_passes(request.passes);
    if (passes_.empty())
        passes_ = png_ ? PassSet(Pass::beauty) : standard_passes;
    if (png_ && passes_ != first(passes_))
        throw UsageError("a .png shows one pass: give --pass once, or write an .exr, which can store several");
    if (png_ && request.precision == Precision::single)
        throw UsageError("--precision float is for .exr: a .png has no floats");
    precision_ = request.precision;
    const AtomicFile probe(file_);
}

std::string ImageOutput::frame_file(int frame, int frames) const {
    const std::filesystem::path path(file_);
    const std::size_t digits = std::max<std::size_t>(4, std::to_string(frames).size());
    return (path.parent_path() /
            fmt::format("{}_{:0{}}{}", path.stem().string(), frame, digits, path.extension().string()))
        .string();
}

void ImageOutput::write(const Image& image, const std::string& file, const Camera& camera,
                        const std::string& comments) const {
    if (png_) {
        write_png(image, file, first(passes_));
        return;
    }
    ImageHeader header;
    header.world_to_camera = camera.world_to_camera();
    header.world_to_ndc = camera.world_to_ndc();
    header.screen_window_width = camera.screen_window_width();
    header.software = "alcove " ALCOVE_VERSION;
    header.comments = comments;
    write_exr(image, file, header, precision_);
}

}
