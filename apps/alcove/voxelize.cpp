#include "common.h"
#include "voxelized.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/parallel.h"
#include "alcove/vdb/vdb_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace alcove::cli {
namespace {

struct VoxelizeVerbOptions {
    CommonOptions common;
    GridRequest grid;
    std::string input, output;
};

void run(const VoxelizeVerbOptions& options) {
    const ThreadLimit limit(options.common.threads);
    check_grid_output(options.output);
    nlohmann::ordered_json seconds;
    const VoxelizedMesh input = read_and_voxelize(options.input, options.grid, options.common, seconds);
    Stopwatch watch;
    write_grids(input.stack, options.output);
    seconds["write"] = watch.lap();

    print_warnings(input.warnings, options.common);
    nlohmann::ordered_json levels = nlohmann::ordered_json::array();
    for (const LevelSet& level : input.stack.levels)
        levels.push_back({{"voxel", level.voxel * input.frame.diagonal},
                          {"band", level.outer_band},
                          {"active_voxels", level.active_voxels},
                          {"bytes", level.bytes}});
    if (options.common.json)
        print_json({{"input", options.input},
                    {"output", options.output},
                    {"vertices", input.mesh.vertex_count()},
                    {"faces", input.mesh.face_count()},
                    {"sign", name_of(input.stack.sign)},
                    {"levels", levels},
                    {"grid_bytes", input.stack.bytes()},
                    {"seconds", seconds},
                    {"peak_rss_bytes", peak_resident_bytes()},
                    {"warnings", input.warnings}});
    else if (!options.common.quiet)
        for (std::size_t i = 0; i < levels.size(); ++i)
            fmt::print("{}: level {}: voxel {:.4g}, {} active voxels, {}\n", options.output, i + 1,
                       levels[i]["voxel"].get<double>(), grouped(levels[i]["active_voxels"]),
                       name_of(input.stack.sign));
}

}

void add_voxelize(CLI::App& program) {
    auto* verb = program.add_subcommand("voxelize", "Turn a mesh into narrow-band level sets");
    auto options = std::make_shared<VoxelizeVerbOptions>();
    verb->add_option("input", options->input, "Mesh (ply, obj, off, stl)")->required();
    verb->add_option("-o,--output", options->output, "Grid to write (vdb)")->required();
    add_radius_option(*verb, options->grid,
                      "How far distances are wanted; each level doubles the voxel until it is met");
    add_grid_options(*verb, options->grid);
    verb->add_option("--band", options->grid.band, "Voxels outward from the surface on each level")
        ->check(CLI::Range(3.0, 100.0).description(""))
        ->type_name("N")
        ->capture_default_str();
    add_common_options(*verb, options->common);
    verb->footer("Example:\n  alcove voxelize scan.ply -o scan.vdb --voxel 0.2% --radius 20%\n");
    verb->callback([options] { run(*options); });
}

}
