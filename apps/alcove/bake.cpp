#include "bake_input.h"
#include "baking.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/errors.h"
#include "alcove/mesh/detail/source.h"
#include "alcove/mesh/write.h"
#include "alcove/vdb/vdb_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <sstream>

namespace alcove::cli {
namespace {

struct BakeOptions {
    CommonOptions common;
    GridRequest grid;
    MethodRequest method;
    BakeInputRequest source;
    SurroundingsRequest surroundings;
    PlanningRequest planning;
    std::string output, attributes = "ao", normals = "auto", color, color_encoding = "srgb", write_grid;
};

constexpr const char* provenance = "alcove ";

NormalSource parse_normals(const std::string& text) {
    if (text == "auto")
        return NormalSource::automatic;
    if (text == "file")
        return NormalSource::file;
    if (text == "area")
        return NormalSource::area;
    throw UsageError(fmt::format("--normals takes auto, file or area, not '{}'", text));
}

ColorEncoding parse_encoding(const std::string& text) {
    if (text == "srgb")
        return ColorEncoding::srgb;
    if (text == "raw")
        return ColorEncoding::raw;
    throw UsageError(fmt::format("--color-encoding takes srgb or raw, not '{}'", text));
}

ChannelSet parse_attributes(const std::string& text) {
    ChannelSet wanted;
    std::string known;
    for (const ChannelInfo& channel : channels)
        known += fmt::format("{}{}", known.empty() ? "" : ", ", channel.name);
    std::istringstream names(text);
    for (std::string name; std::getline(names, name, ',');) {
        const auto* found = std::find_if(channels.begin(), channels.end(),
                                         [&](const ChannelInfo& channel) { return channel.name == name; });
        if (found == channels.end())
            throw UsageError(fmt::format("--attributes: there is no '{}'; there are: {}", name, known));
        wanted = wanted | found->channel;
    }
    if (wanted.empty())
        throw UsageError("--attributes takes one or more of " + known);
    return wanted;
}

std::string names_of(ChannelSet set) {
    std::string names;
    for (const ChannelInfo& channel : channels)
        if (set.has(channel.channel))
            names += fmt::format("{}{}", names.empty() ? "" : ", ", channel.name);
    return names;
}

/// The channels as attributes of the mesh, lengths in scene units.
void set_attributes(Mesh& mesh, ChannelValues& values, double diagonal) {
    for (float& thickness : values[Channel::thickness])
        thickness = static_cast<float>(thickness * diagonal);
    for (const ChannelInfo& channel : channels)
        if (std::vector<float>& baked = values[channel.channel]; !baked.empty())
            mesh.set_attribute(
                {std::string(channel.name), static_cast<int>(channel.components), std::move(baked)});
}

/// Whether occlusion becomes colours and `quality`: as asked, else unless the input has its own; those of an
/// earlier bake are not its own.
bool wants_colors(const std::string& asked, ChannelSet wanted, const Mesh& mesh) {
    if (!wanted.has(Channel::ao))
        return false;
    if (!asked.empty())
        return asked == "ao";
    if (mesh.source && mesh.source->has_comment(provenance))
        return true;
    return mesh.vertex_colors.empty() && !(mesh.source && mesh.source->has_vertex_property("quality"));
}

BakeTask parse_task(const BakeOptions& options) {
    BakeTask task;
    task.wanted = parse_attributes(options.attributes);
    task.normals = parse_normals(options.normals);
    task.planning = options.planning;
    task.seed = options.method.seed.value_or(0);
    if (!options.planning.error)
        task.method = needed_methods(parse_method(options.method.method), task.wanted).front();
    else if (!task.wanted.has(Channel::ao))
        throw UsageError("--error is that of ao: it needs ao among the --attributes");
    const MethodRequest seeded{.seed = options.method.seed};
    task.settings = task.method ? parse_settings(options.method, *task.method, task.wanted)
                                : parse_settings(seeded, find_method("exact"), task.wanted);
    return task;
}

void check_output(const BakeOptions& options, ChannelSet wanted) {
    const bool to_obj = extension(options.output) == ".obj";
    if (to_obj && !wanted.without(Channel::ao).empty())
        throw UsageError(options.output + ": an .obj holds ao alone, as colours: write a .ply for " +
                         names_of(wanted.without(Channel::ao)));
    if (options.color == "ao" && !wanted.has(Channel::ao))
        throw UsageError("--color ao needs ao among the --attributes");
    if (options.color == "none" && to_obj)
        throw UsageError(options.output +
                         ": an .obj holds occlusion as colours alone: leave out --color none, or write a "
                         ".ply");
    if (!options.color.empty() && options.color != "ao" && options.color != "none")
        throw UsageError(fmt::format("--color takes ao or none, not '{}'", options.color));
    if (!can_write_mesh(options.output))
        throw UsageError(options.output + ": meshes are written as .ply or .obj; name the output so");
    if (!options.write_grid.empty())
        check_grid_output(options.write_grid);
    if (!options.write_grid.empty() && options.source.self)
        throw UsageError("--self makes a grid for each part, --write-grid keeps one: leave out either");
}

std::vector<Surfel> surfels_of(VoxelizedMesh& input, NormalSource normals) {
    if (normals == NormalSource::file && input.mesh.normals.empty())
        throw InputError(input.file + ": has no normals of its own: use --normals area");
    std::vector<Surfel> surfels = make_surfels(input.mesh, input.triangles, input.frame, normals);
    const auto bare =
        std::count_if(surfels.begin(), surfels.end(), [](const Surfel& s) { return !s.has_normal(); });
    if (bare > 0)
        input.warnings.push_back(
            fmt::format("{} of {} vertices have no normal (no face uses them, or their faces "
                        "cancel) and got ao = 1",
                        grouped(static_cast<std::size_t>(bare)), grouped(surfels.size())));
    return surfels;
}

/// Puts the values on the mesh, and writes it.
void write_baked(const BakeOptions& options, ChannelSet wanted, VoxelizedMesh& input, Baked& baked) {
    const bool to_obj = extension(options.output) == ".obj";
    Mesh& mesh = input.mesh;
    ChannelValues& values = baked.values;
    WriteOptions writing;
    writing.comments.push_back(fmt::format(
        "alcove {}: {} by {}, radius {:.6g}, {}", ALCOVE_VERSION, names_of(wanted), baked.choice.label(),
        double(input.radius) * input.frame.diagonal,
        baked.grid.levels > 0 ? fmt::format("voxel {:.6g}", baked.grid.voxel) : baked.grid.text()));
    const bool colored = wants_colors(options.color, wanted, mesh);
    if (!colored && to_obj)
        throw UsageError(options.output +
                         ": an .obj holds occlusion as colours alone, and the input has its own: add "
                         "--color ao to replace them, or write a .ply");
    if (colored)
        writing.colors = grey_colors(values[Channel::ao], parse_encoding(options.color_encoding));
    if (!to_obj) {
        if (colored)
            mesh.set_attribute({"quality", 1, values[Channel::ao]});
        set_attributes(mesh, values, input.frame.diagonal);
    }
    for (std::string& lost : write_mesh(mesh, options.output, writing))
        input.warnings.push_back(std::move(lost));
}

std::string rmse_text(const std::optional<double>& rmse) {
    constexpr double resolution = 1e-3; // of a pilot
    if (!rmse)
        return "";
    return *rmse < resolution ? fmt::format(", RMSE below {}", resolution)
                              : fmt::format(", RMSE about {:.2g}", *rmse);
}

void print_result(const BakeOptions& options, ChannelSet wanted, const VoxelizedMesh& input,
                  const Baked& baked, std::size_t grid_bytes, const nlohmann::ordered_json& seconds) {
    const auto or_null = [](bool there, const auto& value) {
        return there ? nlohmann::ordered_json(value) : nullptr;
    };
    const double radius = double(input.radius) * input.frame.diagonal;
    const bool has_grid = baked.grid.levels > 0;
    if (options.common.json)
        print_json({{"input", options.source.input},
                    {"output", options.output},
                    {"vertices", input.mesh.vertex_count()},
                    {"faces", input.mesh.face_count()},
                    {"attributes", names_of(wanted)},
                    {"method", baked.choice.method->name},
                    {"samples", or_null(baked.choice.samples > 0, baked.choice.samples)},
                    {"radius", radius},
                    {"voxel", or_null(has_grid, baked.grid.voxel)},
                    {"levels", baked.grid.levels},
                    {"sign", or_null(has_grid, name_of(baked.grid.sign))},
                    {"clustered", or_null(has_grid, baked.grid.clustered)},
                    {"grid_bytes", grid_bytes},
                    {"estimated_rmse", or_null(baked.rmse.has_value(), baked.rmse.value_or(0.0))},
                    {"seconds", seconds},
                    {"peak_rss_bytes", peak_resident_bytes()},
                    {"warnings", input.warnings}});
    else if (!options.common.quiet)
        fmt::print("{}: {} of {} vertices by {}, radius {:.4g}, {}{}\n", options.output, names_of(wanted),
                   grouped(input.mesh.vertex_count()), baked.choice.label(), radius, baked.grid.text(),
                   rmse_text(baked.rmse));
}

void run(const BakeOptions& options) {
    const ThreadLimit limit(options.common.threads);
    BakeTask task = parse_task(options);
    parse_encoding(options.color_encoding);
    check_output(options, task.wanted);
    nlohmann::ordered_json seconds;
    GridRequest grid_request = options.grid;
    grid_request.inside = std::any_of(channels.begin(), channels.end(), [&](const ChannelInfo& channel) {
        return channel.inside && task.wanted.has(channel.channel);
    });
    grid_request.cluster = options.write_grid.empty(); // one that is kept is exact
    const bool needs_field = task.needs().field;
    VoxelizedMesh input = read_bake_input(
        options.source, grid_request, needs_field || !options.write_grid.empty(), options.common, seconds);
    Stopwatch watch;
    Surroundings surroundings(options.surroundings, input);
    if (needs_field || !input.stack.levels.empty())
        surroundings.voxelize(input);
    if (!options.write_grid.empty())
        write_grids(input.stack, options.write_grid);
    const double other_grids = watch.lap();

    task.settings.radius = input.radius;
    const std::vector<Surfel> surfels = surfels_of(input, task.normals);
    Baked baked;
    {
        ProgressMeter meter(options.common.progress_mode(), "baking");
        if (!task.method)
            baked = bake_by_plan(input, surroundings, task, surfels, options.common, std::ref(meter));
        else if (options.source.self)
            baked = bake_parts(input, surroundings, task, std::ref(meter));
        else
            baked = bake_whole(input, surroundings, task, surfels, std::ref(meter));
    }
    seconds["grid"] = seconds["grid"].get<double>() + other_grids + baked.grid_seconds;
    seconds["occlusion"] = watch.lap() - baked.grid_seconds - baked.pilot_seconds;
    seconds["pilot"] = baked.pilot_seconds;
    write_baked(options, task.wanted, input, baked);
    seconds["write"] = watch.lap();
    print_warnings(input.warnings, options.common);
    print_result(options, task.wanted, input, baked, baked.grid.bytes + surroundings.bytes(), seconds);
}

}

void add_bake(CLI::App& program) {
    auto* verb =
        program.add_subcommand("bake", "Compute ambient occlusion and masks at the vertices of a mesh");
    auto options = std::make_shared<BakeOptions>();
    verb->add_option("input", options->source.input,
                     "Mesh to bake (ply, obj, off, stl), or grid (vdb) to mesh at its zero surface first")
        ->required();
    verb->add_option("-o,--output", options->output, "Mesh to write (ply, obj)")->required();
    add_radius_option(*verb, options->grid,
                      "How far occluders count: 0.2 (scene units), 10% (of the diagonal), inf");
    add_method_options(*verb, options->method, "Estimator: ");
    verb->add_option("--attributes", options->attributes,
                     "What to bake, with commas between: ao, ao_short, ao_long (multiscale), convexity, "
                     "bent_normal (traced, guided, exact: of their rays; others: of four probes), thickness")
        ->type_name("NAMES")
        ->capture_default_str();
    verb->add_option("--normals", options->normals, "auto: the file's, else area-weighted; file; area")
        ->type_name("SOURCE")
        ->capture_default_str();
    add_planning_options(*verb, options->planning);
    add_grid_options(*verb, options->grid);
    add_bake_input_options(*verb, options->source);
    add_surroundings_options(*verb, options->surroundings);
    verb->add_option("--write-grid", options->write_grid,
                     "Keep the level sets in a .vdb: of all triangles, where a bake otherwise leaves out "
                     "what its voxels cannot tell")
        ->type_name("FILE");
    verb->add_option(
            "--color", options->color,
            "ao: as vertex colours and `quality` too; none. Default: ao, unless the input has either")
        ->type_name("WHAT");
    verb->add_option("--color-encoding", options->color_encoding, "srgb, or raw (255 x ao)")
        ->type_name("CODE")
        ->capture_default_str();
    add_common_options(*verb, options->common);
    verb->footer("Examples:\n"
                 "  alcove bake scan.ply -o scan_ao.ply\n"
                 "  alcove bake part.stl -o part_ao.ply --radius 5% --rays 256\n"
                 "  alcove bake scan.obj -o scan_ao.obj --method classic --voxel 0.2%\n"
                 "  alcove bake scan.ply -o scan_ao.ply --error 0.02\n"
                 "  alcove bake scan.ply -o masks.ply --attributes ao,convexity,bent_normal,thickness\n"
                 "  alcove bake chair.ply -o chair_ao.ply --ground --up 0,0,1 --occluder table.ply\n"
                 "  alcove bake kit.obj -o kit_ao.obj --self\n"
                 "  alcove bake level_set.vdb -o level_set_ao.ply --adaptivity 0.2\n"
                 "  alcove bake scan.ply -o scan_ao.ply --write-grid scan.vdb\n"
                 "  alcove bake scan.ply -o scan_ao.ply --grid scan.vdb --method classic\n");
    verb->callback([options, verb] {
        check_planning(options->planning, *verb);
        run(*options);
    });
}

}
