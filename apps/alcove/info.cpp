#include "facts.h"
#include "inputs.h"
#include "options.h"
#include "weld.h"

#include "alcove/base/detail/messages.h"
#include "alcove/base/parallel.h"
#include "alcove/base/types.h"
#include "alcove/field/level_stack.h"
#include "alcove/render/image.h"
#include "alcove/render/renderer.h"
#include "alcove/vdb/vdb_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>

namespace alcove::cli {
namespace {

struct Options {
    CommonOptions common;
    std::string input;
    std::optional<Length> weld;
};

enum class Kind { mesh, grid, image };

Kind kind_of(const std::string& file) {
    using namespace std::string_view_literals;
    if (is_grid(file)) // not opened here, because it may be a pipe
        return Kind::grid;
    std::array<char, 8> bytes{};
    std::error_code unknown;
    if (std::filesystem::is_regular_file(file, unknown)) // a pipe cannot be read twice
        std::ifstream(file, std::ios::binary).read(bytes.data(), bytes.size());
    const std::string_view begin(bytes.data(), bytes.size());
    if (begin == " BDV\0\0\0\0"sv)
        return Kind::grid;
    if (begin.starts_with("\x76\x2f\x31\x01"sv) || begin == "\x89PNG\r\n\x1a\n"sv || file.ends_with(".exr") ||
        file.ends_with(".png"))
        return Kind::image;
    return Kind::mesh;
}

void add_grids(Facts& facts, const std::string& file, const GridStack& stack) {
    auto grids = nlohmann::ordered_json::array();
    std::vector<std::string> lines;
    for (const StoredGrid& grid : list_grids(file)) {
        const bool used = std::find(stack.sources.begin(), stack.sources.end(), grid.name) != stack.sources.end();
        nlohmann::ordered_json one{{"name", grid.name}, {"type", grid.type}, {"class", grid.grid_class}};
        one["active_voxels"] = grid.active_voxels ? nlohmann::ordered_json(*grid.active_voxels) : nullptr;
        one["used"] = used;
        grids.push_back(std::move(one));
        lines.push_back(fmt::format(
            "{}: {}, {}{}{}", in_quotes(grid.name), grid.type, grid.grid_class,
            grid.active_voxels ? fmt::format(", {} active", grouped(static_cast<std::size_t>(*grid.active_voxels)))
                               : "",
            used ? "" : ", not used"));
    }
    facts.add("grids", grids, lines);
}

Facts facts_of_grid(const std::string& file) {
    const GridStack stack = read_grids(file);
    const double scale = stack.frame.diagonal;
    Facts facts;
    facts.add("kind", "grid");
    facts.add("creator", stack.creator, stack.creator.empty() ? "unknown" : stack.creator);
    facts.add("written_by_alcove", stack.creator == "Alcove");
    const bool sheet = stack.sign == Sign::sheet;
    facts.add("sign", sheet ? "sheet" : "solid",
              sheet ? "negative only in a thin layer behind the faces" : "negative inside");
    try {
        // The size of the cells that outline() samples.
        const double cell = scale / 64;
        facts.add_box(outline(LevelStack(stack), stack.frame).box);
        facts.add("box_tolerance", cell, fmt::format("{:.3g}", cell));
    } catch (const InputError&) {
        facts.add("box", nullptr, "none: no value changes sign, so there is no surface");
    }
    add_grids(facts, file, stack);
    auto levels = nlohmann::ordered_json::array(), partial = levels;
    std::vector<std::string> lines;
    const auto add_level = [&](const LevelSet& level, double voxel, nlohmann::ordered_json& to, const char* kind) {
        to.push_back({{"voxel", voxel},
                      {"active_voxels", level.active_voxels},
                      {"bytes", level.bytes},
                      {"band_voxels", level.outer_band},
                      {"band", level.outer_band * voxel}});
        lines.push_back(fmt::format("voxel {:.6g}, {} active, {:.1f} MB, band {:g} voxels = {:.6g}{}", voxel,
                                    grouped(level.active_voxels), static_cast<double>(level.bytes) / 1e6,
                                    level.outer_band, level.outer_band * voxel, kind));
    };
    for (const LevelSet& level : stack.partial)
        add_level(level, level.voxel * scale, partial, ", near thin walls and narrow gaps only");
    for (std::size_t i = 0; i < stack.levels.size(); ++i)
        add_level(stack.levels[i], stack.scene_voxel(i), levels, "");
    facts.add("diagonal", scale); // the base of percentages; in files written by Alcove, that of the mesh
    facts.add("partial_levels", partial);
    facts.add("levels", levels, lines);
    facts.add("warnings", stack.warnings, stack.warnings);
    return facts;
}

Facts facts_of_image(const std::string& file) {
    const ImageSummary image = summarize_image(file);
    Facts facts;
    facts.add("kind", "image");
    facts.add("format", image.format, image.format);
    facts.add("width", image.width);
    facts.add("height", image.height);
    facts.add("size", {image.width, image.height}, fmt::format("{} x {} pixels", image.width, image.height));
    auto channels = nlohmann::ordered_json::array();
    std::map<std::string, std::string> names_of;
    for (const auto& [name, type] : image.channels) {
        channels.push_back({{"name", name}, {"type", type}});
        names_of[type] += " " + name;
    }
    std::vector<std::string> lines;
    lines.reserve(names_of.size());
    for (const auto& [type, names] : names_of)
        lines.push_back(fmt::format("{}:{}", type, names));
    facts.add("channels", channels, lines);
    auto texts = nlohmann::ordered_json::object();
    lines.clear();
    for (const auto& [name, text] : image.texts) {
        texts[name] = text;
        lines.push_back(fmt::format("{}: {}", name, text));
    }
    facts.add("texts", texts, lines);
    return facts;
}

void run(const Options& options) {
    const ThreadLimit limit(options.common.threads);
    const Kind kind = kind_of(options.input);
    if (kind != Kind::mesh && options.weld)
        throw UsageError("--weld is for meshes: " + options.input + " is not a mesh");
    const Facts facts = kind == Kind::grid    ? facts_of_grid(options.input)
                        : kind == Kind::image ? facts_of_image(options.input)
                                              : facts_of_mesh(read_welded(options.input, options.weld));
    if (options.common.json)
        print_json(facts.json(options.input));
    else
        fmt::print("{}", facts.text(options.input));
}

}

void add_info(CLI::App& program) {
    auto* verb =
        program.add_subcommand("info", "Describe the contents of a mesh, grid or image, and the defects of a mesh");
    auto options = std::make_shared<Options>();
    verb->add_option("file", options->input, "Mesh (ply, obj, off, stl, glb, gltf), grid (vdb) or image (exr, png)")
        ->required();
    add_weld_option(*verb, options->weld);
    add_common_options(*verb, options->common);
    verb->footer("Example: alcove info model.ply");
    verb->callback([options] { run(*options); });
}

}
