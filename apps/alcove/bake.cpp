#include "common.h"
#include "length.h"

#include "alcove/field/level_stack.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/normals.h"
#include "alcove/mesh/read.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/mesh/write.h"
#include "alcove/occlusion/catalog.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>

namespace alcove::cli {
namespace {

struct BakeOptions {
    CommonOptions common;
    std::string input, output, radius = "10%", voxel = "auto", method = "classic";
    EstimatorOptions estimator;
};

void run(const BakeOptions& options) {
    const ThreadLimit limit(options.common.threads);
    Stopwatch watch;
    nlohmann::ordered_json seconds;
    const Method& method = find_method(options.method);
    const Length radius = parse_length(options.radius, "--radius");

    Mesh mesh = read_mesh(options.input);
    const Triangulation triangulation = triangulate(mesh);
    const Frame frame = frame_of(mesh.box());
    seconds["read"] = watch.lap();

    VoxelizeOptions grid;
    if (options.voxel != "auto")
        grid.grid.voxel = parse_length(options.voxel, "--voxel").to_unit(frame.diagonal);
    grid.grid.radius = radius.to_unit(frame.diagonal, grid.grid.voxel);
    ProgressMeter voxelizing(options.common.progress_mode(), "voxelizing");
    grid.progress = std::ref(voxelizing);
    const GridStack stack = voxelize(mesh, triangulation.triangles, grid);
    const LevelStack field(stack);
    seconds["grid"] = watch.lap();

    const std::vector<Surfel> surfels = make_surfels(mesh, triangulation.triangles, frame);
    EstimatorOptions estimator = options.estimator;
    estimator.radius = grid.grid.radius;
    ProgressMeter baking(options.common.progress_mode(), "baking");
    mesh.set_attribute({"ao", 1, method.bake(surfels, field, estimator, std::ref(baking))});
    seconds["occlusion"] = watch.lap();

    std::vector<std::string> warnings = mesh.warnings;
    warnings.insert(warnings.end(), stack.warnings.begin(), stack.warnings.end());
    for (const std::string& lost : write_mesh(mesh, options.output))
        warnings.push_back(lost);
    seconds["write"] = watch.lap();
    print_warnings(warnings, options.common);
    if (options.common.json)
        print_json({{"input", options.input},
                    {"vertices", mesh.vertex_count()},
                    {"faces", mesh.face_count()},
                    {"method", method.name},
                    {"radius", grid.grid.radius * frame.diagonal},
                    {"voxel", stack.levels.front().voxel * frame.diagonal},
                    {"levels", stack.levels.size()},
                    {"grid_bytes", stack.bytes()},
                    {"estimated_rmse", nullptr},
                    {"seconds", seconds},
                    {"peak_rss_bytes", peak_rss_bytes()},
                    {"warnings", warnings}});
}

}

void add_bake(CLI::App& program) {
    auto* verb = program.add_subcommand("bake", "Compute ambient occlusion at the vertices of a mesh");
    auto options = std::make_shared<BakeOptions>();
    verb->add_option("input", options->input, "Mesh to bake (ply, obj, off, stl)")->required();
    verb->add_option("-o,--output", options->output, "Mesh to write (ply, obj)")->required();
    verb->add_option("--radius", options->radius, "How far occluders count: 0.2, 10%, 3vx or inf")
        ->capture_default_str();
    verb->add_option("--voxel", options->voxel, "Edge of the finest voxel: a length, or auto")
        ->capture_default_str();
    verb->add_option("--method", options->method, "Estimator")->capture_default_str();
    verb->add_option("--samples", options->estimator.samples, "Probes a vertex; 0: the method's own");
    verb->add_option("--rays", options->estimator.rays, "Rays a vertex; 0: the method's own");
    verb->add_option("--seed", options->estimator.seed, "Seed of random directions");
    add_common_options(*verb, options->common);
    verb->callback([options] { run(*options); });
}

}
