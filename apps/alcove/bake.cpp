#include "bake_batch.h"
#include "bake_job.h"
#include "bake_verb.h"
#include "weld.h"

#include "alcove/mesh/files.h"

#include <fmt/format.h>

#include <memory>

namespace alcove::cli {
namespace {

void choose_attributes(BakeVerb& verb, EnumSet<MapAttribute> attributes) {
    verb.bake.attributes = channels_of(attributes);
    verb.map.map.surface = attributes.without(attributes_of(verb.bake.attributes));
}

void run(BakeVerb& verb) {
    verb.bake.threads = verb.common.threads;
    verb.bake.method = verb.method.method;
    verb.bake.quality = verb.quality.value_or(verb.bake.quality);
    if (verb.quality && !verb.method.method.empty()) // the quality tunes the method, as --error does
        verb.bake.error = rmse_of(*verb.quality);
    verb.bake.parameters = verb.method.parameters;
    verb.bake.seed = verb.method.seed.value_or(0);
    verb.bake.up = verb.up.value_or(verb.bake.up);
    verb.bake.keep_grid = !verb.write_grid.empty();
    if (!verb.map.files.pack.empty()) {
        EnumSet<MapAttribute> packed;
        for (const PackedChannel& channel : verb.map.files.pack)
            if (channel.attribute)
                packed = packed | *channel.attribute;
        if (packed.empty())
            throw UsageError("--pack needs at least one attribute, such as ao,1");
        choose_attributes(verb, packed);
    }
    check_options(verb);
    const std::vector<BatchFile> files = batch_files(verb.inputs, verb.output);
    for (const BatchFile& file : files)
        check_output(verb, file.output);
    for (const std::string& occluder : verb.occluders) {
        verb.bake.occluders.push_back(read_mesh(occluder));
        for (const std::string& warning : verb.bake.occluders.back().warnings)
            print_warnings({fmt::format("{}: {}", occluder, warning)}, verb.common);
    }
    run_batch(files, verb.common,
              [&](const BatchFile& file, const BakeProgress& progress) { bake_file(verb, file, progress); });
}

void add_files(CLI::App& app, BakeVerb& verb) {
    app.add_option("input", verb.inputs,
                   "Meshes to bake (ply, obj, off, stl, glb, gltf), points with normals (ply), or level sets (vdb), "
                   "whose zero isosurface is meshed first")
        ->required();
    app.add_option("-o,--output", verb.output,
                   "Mesh to write (ply, obj, glb, gltf), texture map (png, exr), or a folder that gets one mesh per "
                   "input. If the name of a map contains <UDIM>, one file is written per tile")
        ->required();
}

/// Adds the options for the radius, the accuracy and the method.
void add_planning(CLI::App& app, BakeVerb& verb) {
    BakeOptions& bake = verb.bake;
    add_radius_option(app, bake.radius,
                      "Maximum distance of occluders: 0.2 (scene units), 10% (of the diagonal), or inf");
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
            "Methods to choose from. grid: methods that use level sets, or exact rays if level sets would cost far "
            "more, miss the error, are too coarse for the radius, or do not fit in memory; auto: all; mesh: exact rays")
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

/// Adds the options for the attributes, and for the vertices to bake.
void add_surface(CLI::App& app, BakeVerb& verb) {
    BakeOptions& bake = verb.bake;
    app.add_option_function<std::string>(
           "--attributes", [&verb](const std::string& names) { choose_attributes(verb, parse_attributes(names)); },
           "What to bake, separated by commas: ao, convexity, bent_normal, thickness; with --method multiscale also "
           "ao_short, ao_long; with --high also normal, height, position, object")
        ->check(parsable(parse_attributes))
        ->type_name("NAMES")
        ->default_str("ao");
    add_choice<NormalSource>(
        app, "--normals", bake.normals,
        {{"auto", NormalSource::automatic},
         {"file", NormalSource::file},
         {"angle", NormalSource::angle},
         {"area", NormalSource::area}},
        "file: the file's normals; angle, area: means of the face normals, weighted by the angle of each face at the "
        "vertex, or by its area; auto: the file's normals if it has any, else angle (in texture maps, "
        "edges whose face normals differ by more than 40 degrees stay hard)")
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
    app.add_option(
           "--only", faces.only,
           "Bake only parts with this name; all others still occlude. NAME can be the name of a node, mesh "
           "or material (glTF), or of a group, object or material (OBJ); * and ? are wildcards. Repeat the option "
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
        "ao: also write ao as vertex colours and as the attribute `quality`; multiply: multiply the vertex colours of "
        "the input by ao; none: do neither. Default: ao, or none if the input has vertex colours or an attribute "
        "`quality` of its own")
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
        "bake", "Bake ambient occlusion and masks into the vertices of meshes or into texture maps");
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
