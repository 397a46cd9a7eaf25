#include "bake_batch.h"
#include "ending.h"
#include "inputs.h"
#include "map_output.h"
#include "options.h"
#include "weld.h"

#include "alcove/bake/bake.h"
#include "alcove/base/detail/atomic_file.h"
#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/detail/stopwatch.h"
#include "alcove/mesh/detail/join.h"
#include "alcove/mesh/detail/tessellate.h"
#include "alcove/mesh/files.h"
#include "alcove/vdb/vdb_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <sstream>

namespace alcove::cli {
namespace {

struct BakeVerb {
    CommonOptions common;
    BakeOptions bake;
    AddOptions add;
    MapRequest map;
    MethodRequest method;
    std::vector<std::string> inputs, occluders, grid_names;
    std::string output, grid, write_grid, tessellate;
    std::optional<Vec3d> up;
    std::optional<Quality> quality;
    float adaptivity = 0.0f;
    bool strict = false;
};

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
            throw InputError(fmt::format("takes {}, separated by commas, not '{}'", known, name));
        wanted = wanted | found->channel;
    }
    if (wanted.empty())
        throw InputError("takes one or more of " + known);
    return wanted;
}

/// Checks the command line before any file is read.
void check_usage(const BakeVerb& verb) {
    const bool meshed = std::any_of(verb.inputs.begin(), verb.inputs.end(), is_grid);
    if (meshed && !verb.grid.empty())
        throw UsageError("--grid is for meshes: a .vdb input is a grid already");
    if (!meshed && verb.grid.empty() && !verb.grid_names.empty())
        throw UsageError("--grid-name is for grids: " + verb.inputs.front() + " is a mesh");
    if (!meshed && verb.adaptivity > 0.0f)
        throw UsageError("--adaptivity is for grids: " + verb.inputs.front() + " is a mesh already");
    if (meshed && !verb.tessellate.empty())
        throw UsageError("--tessellate is for meshes: a .vdb input is meshed with faces of one voxel");
    if (meshed && verb.bake.weld)
        throw UsageError("--weld is for meshes: a .vdb input has no vertices");
    if (verb.inputs.size() > 1 && (!verb.grid.empty() || !verb.write_grid.empty()))
        throw UsageError("--grid and --write-grid take one input: bake the inputs one at a time");
    if (!verb.write_grid.empty())
        check_grid_output(verb.write_grid);
    if (verb.strict && !verb.bake.method.empty() && !verb.bake.error)
        throw UsageError("--strict needs an --error for the --method to meet");
    if ((verb.add.color == ColorUse::ao || verb.add.color == ColorUse::multiply) &&
        !verb.bake.attributes.has(Channel::ao))
        throw UsageError("--color ao and --color multiply need ao among the --attributes");
    BakeOptions options = verb.bake;
    const GridStack any;
    if (meshed || !verb.grid.empty())
        options.grid = &any;
    if (!verb.map.map.surface.empty()) // needs no other attribute
        options.attributes = options.attributes | Channel::ao;
    as_usage([&] { check(options); });
}

/// Refuses options for values at vertices.
void check_at_vertices(const BakeVerb& verb, const std::string& output, std::string_view instead) {
    const auto refuse = [&](bool given, std::string_view option) {
        if (given)
            throw UsageError(fmt::format("{} is for values at vertices, but {}: {}", option, instead, output));
    };
    refuse(!verb.tessellate.empty(), "--tessellate");
    refuse(verb.bake.self, "--self");
    refuse(verb.bake.weld.has_value(), "--weld");
    refuse(verb.add.color != ColorUse::automatic, "--color");
    refuse(!verb.write_grid.empty(), "--write-grid");
}

void check_map_usage(const BakeVerb& verb, const std::string& output) {
    check_at_vertices(verb, output, "the output is a texture map");
    if (!verb.bake.faces.empty() && !verb.map.high.empty())
        throw UsageError(
            "--only, --exclude, --no-occlude and --opaque-only choose parts of the input, but --high bakes "
            "other meshes: leave out one of them");
    as_usage([&] {
        MapOptions map = verb.map.map;
        map.high.resize(verb.map.high.size()); // read later
        if (!verb.map.cage.empty())
            map.cage.emplace();
        check(map);
        check(verb.map.files, output);
        if (!verb.map.miss_mask.empty())
            check_miss_mask(verb.map, output);
    });
    const AtomicFile probe(output); // to find out early
}

bool is_gltf(const std::string& output) {
    return extension(output) == ".glb" || extension(output) == ".gltf";
}

/// Checks the options of occlusion textures.
void check_texture_usage(const BakeVerb& verb, const std::string& output) {
    if (!is_gltf(output))
        throw UsageError(fmt::format("--into texture is for .glb and .gltf: {} is neither", output));
    if (verb.map.given_beyond_size() || !(verb.bake.attributes == Channel::ao))
        throw UsageError("--into texture writes only ao: it accepts --size, --subsamples and --margin, but no other "
                         "options for maps and no other --attributes");
    check_at_vertices(verb, output, "an occlusion texture is written");
    as_usage([&] { check(verb.map.map); });
    can_write_mesh(output); // to find out early
}

void check_format(const BakeVerb& verb, const std::string& output) {
    if (verb.map.into_texture)
        return check_texture_usage(verb, output);
    if (is_map(output))
        return check_map_usage(verb, output);
    if (verb.map.given())
        throw UsageError(
            "--size, --subsamples, --margin, --depth, --space, --flip-green, --uv-set, --high, --reach, --cage, "
            "--miss-mask, --pack, and the attributes of a high mesh are for texture maps: write a .png or .exr");
    const ChannelSet others = verb.bake.attributes.without(Channel::ao);
    if (extension(output) == ".obj" && !others.empty())
        throw UsageError(output + ": an .obj can store only ao, as colours: write a .ply for " + names_of(others));
    if (extension(output) == ".obj" && verb.add.color == ColorUse::none)
        throw UsageError(output + ": an .obj can store ao only as colours: leave out --color none, or write a .ply");
    if (!can_write_mesh(output))
        throw UsageError(output +
                         ": meshes are written as .ply, .obj, .glb or .gltf, texture maps as .png or .exr: use one of "
                         "these extensions");
}

std::string rmse_text(const Baked& baked) {
    constexpr double resolution = 1e-3; // of the measured error
    if (!baked.rmse)
        return "";
    return *baked.rmse < resolution ? fmt::format(", RMSE below {}", resolution)
                                    : fmt::format(", RMSE about {:.2g}", *baked.rmse);
}

std::string evaluated_text(const Baked& baked) {
    return baked.evaluated < 1.0 ? fmt::format(" at {:.2g} % of them, the others interpolated", 100.0 * baked.evaluated)
                                 : "";
}

/// How the values were computed, and their error.
std::string method_text(const Baked& baked) {
    return fmt::format(" by {}{}, radius {:.4g}, {}{}{}", baked.method, evaluated_text(baked), baked.radius,
                       baked.grid_summary.text(), rmse_text(baked),
                       baked.reason.empty() ? "" : fmt::format(" (no grid used: {})", baked.reason));
}

/// One input, from reading to writing.
class BakeJob {
  public:
    BakeJob(const BakeVerb& verb, const BatchFile& file) : verb_(verb), file_(file) {}

    void run(const BakeProgress& progress) {
        BakeOptions options = verb_.bake;
        options.progress = progress;
        if (const std::optional<double> left = seconds_left())
            options.time_limit = left;
        Stopwatch watch;
        read(options);
        seconds_["read"] = watch.lap();
        std::optional<BakedMaps> maps;
        OcclusionTextures textures;
        if (verb_.map.into_texture) {
            textures = bake_occlusion_textures(mesh_, options, verb_.map.map);
            maps = std::move(textures.maps);
        } else if (is_map(file_.output)) {
            maps = bake_maps(mesh_, options, map_options());
        }
        const Baked baked = maps ? std::move(maps->baked) : bake(mesh_, options);
        seconds_["grid"] = baked.seconds.grid;
        seconds_["occlusion"] = baked.seconds.occlusion;
        seconds_["pilot"] = baked.seconds.pilot;
        if (verb_.strict && baked.missed())
            throw std::runtime_error(
                fmt::format("{}: misses the error target of {:g}: the measured RMSE is {:.2g}, and nothing is written",
                            file_.input, *baked.target, *baked.rmse));
        watch.lap();
        if (verb_.map.into_texture) {
            textures.maps = std::move(*maps);
            for (std::string& message : write_occlusion_textures(mesh_, textures, file_.output))
                warnings_.push_back(std::move(message));
            maps = std::move(textures.maps);
        } else if (maps) {
            write_maps(*maps, file_.output, verb_.map.files);
            if (!verb_.map.miss_mask.empty())
                write_miss_mask(*maps, verb_.map.miss_mask);
        } else {
            write(baked);
        }
        seconds_["write"] = watch.lap();
        warnings_.insert(warnings_.begin(), baked.warnings.begin(), baked.warnings.end());
        warnings_.insert(warnings_.begin(), mesh_.warnings.begin(), mesh_.warnings.end());
        warnings_.insert(warnings_.begin(), grid_.warnings.begin(), grid_.warnings.end());
        for (const std::string& warning : warnings_)
            print_warnings({verb_.inputs.size() > 1 ? fmt::format("{}: {}", file_.input, warning) : warning},
                           verb_.common);
        print(baked, maps);
    }

  private:
    MapOptions map_options() const {
        MapOptions options = verb_.map.map;
        options.udim = file_.output.find("<UDIM>") != std::string::npos;
        for (const std::string& high : verb_.map.high) {
            options.high.push_back(is_grid(high) ? surface_of(read_grids(high), high) : with_surface(read_mesh(high)));
            for (const std::string& warning : options.high.back().warnings)
                print_warnings({fmt::format("{}: {}", high, warning)}, verb_.common);
        }
        if (!verb_.map.cage.empty())
            options.cage = read_mesh(verb_.map.cage);
        return options;
    }

    void read(BakeOptions& options) {
        if (is_grid(file_.input)) {
            grid_ = read_grids(file_.input, {verb_.grid_names});
            mesh_ = surface_of(grid_, file_.input, verb_.adaptivity);
        } else {
            mesh_ = read_mesh(file_.input);
            if (options.weld && mesh_.format == "STL") // its vertices come from joining anyway
                mesh_ = join_vertices(mesh_, *std::exchange(options.weld, std::nullopt)).mesh;
            if (!verb_.grid.empty())
                grid_ = read_grids(verb_.grid, {verb_.grid_names});
        }
        if (mesh_.face_count() == 0 && is_gltf(file_.output))
            throw InputError(fmt::format("{}: points are not written as glTF: write a .ply", file_.input));
        if (!grid_.levels.empty())
            options.grid = &grid_;
        if (verb_.tessellate == "auto")
            mesh_ = tessellate_for_ao(mesh_, options);
        else if (!verb_.tessellate.empty()) {
            const double diagonal = frame_of(mesh_.box()).diagonal;
            mesh_ = tessellate(mesh_, {.longest = Length(verb_.tessellate).to_unit(diagonal) * diagonal});
        }
    }

    void write(const Baked& baked) {
        if (!verb_.write_grid.empty())
            write_grids(baked.grid, verb_.write_grid);
        if (!add(mesh_, baked, verb_.add) && extension(file_.output) == ".obj")
            throw UsageError(file_.output +
                             ": an .obj can store ao only as colours, but the input has its own: add --color "
                             "ao to replace them, or write a .ply");
        for (std::string& lost : write_mesh(mesh_, file_.output))
            warnings_.push_back(std::move(lost));
    }

    std::size_t baked_vertices(const Baked& baked) const {
        return baked.selected.empty()
                   ? mesh_.vertex_count()
                   : static_cast<std::size_t>(std::count(baked.selected.begin(), baked.selected.end(), 1));
    }

    void print(const Baked& baked, const std::optional<BakedMaps>& maps) const {
        const auto or_null = [](bool there, const auto& value) {
            return there ? nlohmann::ordered_json(value) : nullptr;
        };
        const GridSummary& grid = baked.grid_summary;
        nlohmann::ordered_json size;
        if (maps)
            size = {maps->width, maps->height};
        if (verb_.common.json)
            print_json({{"input", file_.input},
                        {"output", file_.output},
                        {"vertices", mesh_.vertex_count()},
                        {"faces", mesh_.face_count()},
                        {"size", size},
                        {"texels", or_null(maps.has_value(), maps ? maps->texels : 0)},
                        {"overlaps", or_null(maps.has_value(), maps ? maps->overlaps : 0)},
                        {"misses", or_null(maps && maps->reach > 0.0, maps ? maps->misses : 0)},
                        {"reach", or_null(maps && maps->reach > 0.0, maps ? maps->reach : 0.0)},
                        {"attributes", maps ? attributes_of(*maps) : names_of(baked.attributes)},
                        {"method", or_null(!baked.method.empty(), baked.method.substr(0, baked.method.find(':')))},
                        {"samples", or_null(baked.samples.has_value(), baked.samples.value_or(0))},
                        {"evaluated", baked.evaluated},
                        {"reason", or_null(!baked.reason.empty(), baked.reason)},
                        {"radius", baked.radius},
                        {"voxel", or_null(grid.levels > 0, grid.voxel)},
                        {"levels", grid.levels},
                        {"sign", or_null(grid.levels > 0, name_of(grid.sign))},
                        {"clustered", or_null(grid.levels > 0, grid.clustered)},
                        {"grid_bytes", grid.bytes},
                        {"estimated_rmse", or_null(baked.rmse.has_value(), baked.rmse.value_or(0.0))},
                        {"seconds", seconds_},
                        {"peak_rss_bytes", peak_resident_bytes()},
                        {"warnings", warnings_}},
                       verb_.inputs.size() > 1);
        else if (!verb_.common.quiet)
            say(fmt::format(
                "{}: {}{}", file_.output,
                maps ? summary_of(*maps)
                     : fmt::format("{} of {} vertices", names_of(baked.attributes), grouped(baked_vertices(baked))),
                baked.method.empty() ? "" : method_text(baked)));
    }

    const BakeVerb& verb_;
    const BatchFile& file_;
    Mesh mesh_;
    GridStack grid_;
    nlohmann::ordered_json seconds_;
    std::vector<std::string> warnings_;
};

void run(BakeVerb& verb) {
    verb.bake.threads = verb.common.threads;
    verb.bake.method = verb.method.method;
    verb.bake.quality = verb.quality.value_or(verb.bake.quality);
    if (verb.quality && !verb.method.method.empty()) // tunes the method, as --error does
        verb.bake.error = rmse_of(*verb.quality);
    verb.bake.parameters = verb.method.parameters;
    verb.bake.seed = verb.method.seed.value_or(0);
    verb.bake.up = verb.up.value_or(verb.bake.up);
    verb.bake.keep_grid = !verb.write_grid.empty();
    if (!verb.map.files.pack.empty()) {
        ChannelSet packed;
        for (const PackedChannel& channel : verb.map.files.pack)
            if (channel.attribute && *channel.attribute < MapAttribute::normal)
                packed = packed | static_cast<Channel>(*channel.attribute);
            else if (channel.attribute)
                verb.map.map.surface = verb.map.map.surface | *channel.attribute;
        if (packed.empty() && verb.map.map.surface.empty())
            throw UsageError("--pack needs at least one attribute, such as ao,1");
        verb.bake.attributes = packed;
    }
    check_usage(verb);
    const std::vector<BatchFile> files = batch_files(verb.inputs, verb.output);
    for (const BatchFile& file : files)
        check_format(verb, file.output);
    for (const std::string& occluder : verb.occluders) {
        verb.bake.occluders.push_back(read_mesh(occluder));
        for (const std::string& warning : verb.bake.occluders.back().warnings)
            print_warnings({fmt::format("{}: {}", occluder, warning)}, verb.common);
    }
    run_batch(files, verb.common,
              [&](const BatchFile& file, const BakeProgress& progress) { BakeJob(verb, file).run(progress); });
}

void add_files(CLI::App& app, BakeVerb& verb) {
    app.add_option("input", verb.inputs,
                   "Meshes to bake (ply, obj, off, stl, glb, gltf), points with normals (ply), or level sets (vdb), "
                   "whose zero isosurface is meshed first")
        ->required();
    app.add_option("-o,--output", verb.output,
                   "Mesh to write (ply, obj, glb, gltf), texture map (png, exr), or a folder that gets one mesh per "
                   "input. <UDIM> in "
                   "the name of a map: one file per tile")
        ->required();
}

/// The radius, the accuracy and the method.
void add_planning(CLI::App& app, BakeVerb& verb) {
    BakeOptions& bake = verb.bake;
    add_radius_option(app, bake.radius, "Maximum distance of occluders: 0.2 (scene units), 10% (of the diagonal), inf");
    CLI::Option* quality = add_choice<std::optional<Quality>>(
        app, "--quality", verb.quality, {{"draft", Quality::draft}, {"good", Quality::good}, {"fine", Quality::fine}},
        "Maximum RMSE against exact rays: draft 0.05, good 0.02, fine 0.005; the planner picks the fastest method");
    quality->type_name("NAME")->default_str("good");
    app.add_option("--error", bake.error, "Maximum RMSE as a number, at least 0.001 and below 1")
        ->excludes(quality)
        ->type_name("E");
    CLI::Option* via =
        add_choice<Via>(
            app, "--via", bake.via, {{"grid", Via::grid}, {"auto", Via::automatic}, {"mesh", Via::mesh}},
            "Methods to choose from. grid: methods that use level sets, plus exact rays only where level sets "
            "would cost far more; auto: all; mesh: exact rays")
            ->type_name("NAME")
            ->default_str("grid");
    app.add_flag("--strict", verb.strict, "Fail with exit code 1, and write nothing, if the error target is not met");
    add_method_options(app, verb.method,
                       "Use this method, with its default settings or, if --error is given, with as many rays or "
                       "samples as it takes to reach that error. One of: ");
    via->excludes(app.get_option("--method"));
    app.add_flag_callback(
        "--no-pilot", [&bake] { bake.pilot = false; },
        "Shoot no reference rays: the error of the bake is not measured, and the 'calibrated' method is not fitted to "
        "the mesh");
}

/// The attributes, and the vertices to bake.
void add_surface(CLI::App& app, BakeVerb& verb) {
    BakeOptions& bake = verb.bake;
    app.add_option_function<std::string>(
           "--attributes",
           [&verb](std::string names) {
               verb.map.map.surface = take_surface_attributes(names);
               verb.bake.attributes = names.empty() ? ChannelSet() : parse_attributes(names);
           },
           "What to bake, separated by commas: ao, convexity, bent_normal, thickness; with --method multiscale also "
           "ao_short, ao_long; with --high also normal, height, position, object")
        ->check(parsable([](std::string names) {
            if (take_surface_attributes(names).empty() || !names.empty())
                parse_attributes(names);
        }))
        ->type_name("NAMES")
        ->default_str("ao");
    add_choice<NormalSource>(
        app, "--normals", bake.normals,
        {{"auto", NormalSource::automatic},
         {"file", NormalSource::file},
         {"angle", NormalSource::angle},
         {"area", NormalSource::area}},
        "file: the file's normals; angle, area: means of the face normals, weighted by face angle at the vertex or by "
        "face area; auto: the file's normals if it has any, else angle; for maps, with hard edges above 40 degrees")
        ->type_name("SOURCE")
        ->default_str("auto");
    add_weld_option(app, verb.bake.weld);
    add_point_size(app, verb.bake.point_size);
    app.add_option("--tessellate", verb.tessellate,
                   "Split faces first, so that ao can vary across them. LEN: split edges longer than this; auto: split "
                   "where interpolating ao between vertices would be off by more than the error target")
        ->check(parsable([](const std::string& text) {
            if (text != "auto")
                length_without_vx(text, "auto, 0.2 (scene units) or 10% (of the diagonal)");
        }))
        ->type_name("LEN");
}

void add_grids(CLI::App& app, BakeVerb& verb) {
    add_grid_options(app, verb.bake.voxel, verb.bake.sign);
    app.add_option("--grid", verb.grid, "Level set of the mesh (vdb), used instead of voxelizing")->type_name("FILE");
    add_grid_names(app, verb.grid_names);
    app.add_option("--adaptivity", verb.adaptivity,
                   "How adaptively to mesh a grid, from 0 (quads only) to 1 (large faces where the surface is flat)")
        ->check(CLI::Range(0.0, 1.0).description(""))
        ->type_name("A")
        ->capture_default_str();
    app.add_option(
           "--write-grid", verb.write_grid,
           "Also write the level sets to a .vdb. They are then built from the full mesh; without this option, vertices "
           "less than half a voxel apart may be merged first")
        ->type_name("FILE");
}

void add_occluders(CLI::App& app, BakeVerb& verb) {
    FaceSelection& faces = verb.bake.faces;
    app.add_option("--only", faces.only,
                   "Bake only parts with this name; all others still occlude. NAME is that of a node, mesh or "
                   "material (glTF), or of a group, object or material (OBJ); * and ? are wildcards. Repeat the option "
                   "for more")
        ->option_text("NAME");
    app.add_option("--exclude", faces.exclude, "Neither bake parts with this name, nor let them occlude")
        ->option_text("NAME");
    app.add_option("--no-occlude", faces.no_occlude, "Do not let parts with this name occlude")->option_text("NAME");
    app.add_flag("--opaque-only", faces.opaque_only, "Parts with a masked or blended glTF material do not occlude");
    app.add_flag("--self", verb.bake.self,
                 "Each connected part is occluded only by itself, by --occluder meshes and by the --ground plane");
    app.add_option("--occluder", verb.occluders,
                   "Another mesh that occludes, in the same coordinates as the input; repeat the option for more")
        ->option_text("MESH");
    app.add_flag("--ground", verb.bake.ground, "Add an occluding plane through the lowest vertex");
    add_triple(app, "--up", verb.up, Triple::direction, "Up direction for --ground")
        ->needs("--ground")
        ->default_str("0,1,0");
}

void add_colors(CLI::App& app, BakeVerb& verb) {
    add_choice<ColorUse>(
        app, "--color", verb.add.color,
        {{"ao", ColorUse::ao}, {"multiply", ColorUse::multiply}, {"none", ColorUse::none}},
        "ao: also write ao as vertex colours and `quality`; multiply: multiply the vertex colours of the input by ao; "
        "none: do neither. Default: ao, unless the input has "
        "vertex colours or its own `quality`")
        ->type_name("WHAT");
    add_choice<ColorEncoding>(app, "--color-encoding", verb.add.encoding,
                              {{"srgb", ColorEncoding::srgb}, {"raw", ColorEncoding::raw}},
                              "Encoding of the vertex colours in a ply or obj: srgb, or raw (255 x ao)")
        ->type_name("CODE")
        ->default_str("srgb");
}

constexpr const char* examples = "Examples:\n"
                                 "  alcove bake scan.ply -o scan_ao.ply\n"
                                 "  alcove bake part.stl -o part_ao.ply --radius 5% --quality fine\n"
                                 "  alcove bake parts/*.stl -o baked/\n"
                                 "  alcove bake scan.obj -o scan_ao.obj --method classic --voxel 0.2%\n"
                                 "  alcove bake scan.ply -o masks.ply --attributes ao,convexity,bent_normal,thickness\n"
                                 "  alcove bake chair.ply -o chair_ao.ply --ground --up 0,0,1 --occluder table.ply\n"
                                 "  alcove bake level.obj -o level_ao.ply --tessellate auto\n"
                                 "  alcove bake kit.obj -o kit_ao.obj --self\n"
                                 "  alcove bake dragon.obj -o dragon_ao.png --size 4096\n"
                                 "  alcove bake scene.glb -o scene_ao.glb --exclude 'Sky*' --no-occlude Glass\n"
                                 "  alcove bake level_set.vdb -o level_set_ao.ply --adaptivity 0.2\n"
                                 "  alcove bake scan.ply -o scan_ao.ply --write-grid scan.vdb\n"
                                 "  alcove bake scan.ply -o scan_ao.ply --grid scan.vdb --method classic\n";

}

void add_bake(CLI::App& program) {
    auto* app = program.add_subcommand(
        "bake", "Compute ambient occlusion and masks at the vertices of meshes, or as texture maps");
    auto verb = std::make_shared<BakeVerb>();
    add_files(*app, *verb);
    add_planning(*app, *verb);
    add_surface(*app, *verb);
    add_grids(*app, *verb);
    add_occluders(*app, *verb);
    add_colors(*app, *verb);
    add_map_options(*app, verb->map);
    add_common_options(*app, verb->common);
    app->footer(examples);
    app->callback([verb] { run(*verb); });
}

}
