#include "options.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/detail/stopwatch.h"
#include "alcove/base/parallel.h"
#include "alcove/mesh/read.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/vdb/vdb_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace alcove::cli {
namespace {

struct VoxelizeVerb {
    CommonOptions common;
    Length radius = "10%";
    std::optional<Length> voxel;
    VoxelizeOptions voxelizing;
    std::string input, output;
};

GridStack voxelized(const VoxelizeVerb& verb, const Mesh& mesh) {
    VoxelizeOptions options = verb.voxelizing;
    const double diagonal = frame_of(mesh.box()).diagonal;
    options.grid.voxel = verb.voxel ? as_usage([&] { return verb.voxel->to_unit(diagonal); }) : 0.0f;
    options.grid.radius = as_usage([&] { return verb.radius.to_unit(diagonal, options.grid.voxel); });
    ProgressMeter meter(verb.common.progress_mode(), "voxelizing");
    options.progress = std::ref(meter);
    try {
        return voxelize(mesh, triangulate(mesh).triangles, options);
    } catch (const InputError& error) {
        throw InputError(verb.input + ": " + error.what());
    } catch (const LimitError& error) {
        throw LimitError(verb.input + ": " + error.what());
    }
}

void run(const VoxelizeVerb& verb) {
    const ThreadLimit limit(verb.common.threads);
    check_grid_output(verb.output);
    if (!verb.voxel && verb.radius.unit == Length::Unit::voxels)
        throw UsageError("--radius in vx needs a voxel of known size: give --voxel as 0.2 (scene units) or 0.5%");
    nlohmann::ordered_json seconds;
    Stopwatch watch;
    const Mesh mesh = read_mesh(verb.input);
    seconds["read"] = watch.lap();
    const GridStack stack = voxelized(verb, mesh);
    seconds["grid"] = watch.lap();
    write_grids(stack, verb.output);
    seconds["write"] = watch.lap();

    std::vector<std::string> warnings = mesh.warnings;
    warnings.insert(warnings.end(), stack.warnings.begin(), stack.warnings.end());
    print_warnings(warnings, verb.common);
    nlohmann::ordered_json levels = nlohmann::ordered_json::array();
    for (const LevelSet& level : stack.levels)
        levels.push_back({{"voxel", level.voxel * stack.frame.diagonal},
                          {"band", level.outer_band},
                          {"active_voxels", level.active_voxels},
                          {"bytes", level.bytes}});
    if (verb.common.json)
        print_json({{"input", verb.input},
                    {"output", verb.output},
                    {"vertices", mesh.vertex_count()},
                    {"faces", mesh.face_count()},
                    {"sign", name_of(stack.sign)},
                    {"levels", levels},
                    {"grid_bytes", stack.bytes()},
                    {"seconds", seconds},
                    {"peak_rss_bytes", peak_resident_bytes()},
                    {"warnings", warnings}});
    else if (!verb.common.quiet)
        for (std::size_t i = 0; i < levels.size(); ++i)
            fmt::print("{}: level {}: voxel {:.4g}, {} active voxels, {}\n", verb.output, i + 1,
                       levels[i]["voxel"].get<double>(), grouped(levels[i]["active_voxels"]), name_of(stack.sign));
}

}

void add_voxelize(CLI::App& program) {
    auto* app = program.add_subcommand("voxelize", "Turn a mesh into narrow-band level sets");
    auto verb = std::make_shared<VoxelizeVerb>();
    app->add_option("input", verb->input, "Mesh (ply, obj, off, stl)")->required();
    app->add_option("-o,--output", verb->output, "Grid to write (vdb)")->required();
    add_radius_option(*app, verb->radius,
                      "Maximum distance to store; levels with doubled voxels are added until they reach it");
    add_grid_options(*app, verb->voxel, verb->voxelizing.sign);
    app->add_option("--band", verb->voxelizing.grid.outer_band,
                    "Width of the band outside the surface on each level, in voxels")
        ->check(CLI::Range(3.0, 100.0).description(""))
        ->type_name("N")
        ->capture_default_str();
    add_common_options(*app, verb->common);
    app->footer("Example:\n  alcove voxelize scan.ply -o scan.vdb --voxel 0.2% --radius 20%\n");
    app->callback([verb] { run(*verb); });
}

}
