#include "bake_input.h"

#include "length.h"

#include "alcove/base/detail/messages.h"
#include "alcove/base/errors.h"
#include "alcove/field/level_stack.h"
#include "alcove/grid/zero_surface.h"
#include "alcove/mesh/read.h"
#include "alcove/vdb/vdb_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace alcove::cli {
namespace {

void check(const BakeInputRequest& request, const GridRequest& grid) {
    const bool meshed = extension(request.input) == ".vdb";
    if (meshed && !request.grid.empty())
        throw UsageError("--grid is for meshes: " + request.input + " is a grid already");
    if (!meshed && request.adaptivity > 0.0f)
        throw UsageError("--adaptivity is for grids: " + request.input + " is a mesh already");
    if (!meshed && request.grid.empty())
        return;
    const std::string& file = meshed ? request.input : request.grid;
    if (request.self)
        throw UsageError("--self voxelizes each part of a mesh, " + file +
                         " is one grid of all: leave out either");
    if (grid.voxel != "auto" || grid.sign != "auto")
        throw UsageError("--voxel and --sign are for voxelizing: " + file + " is a grid already");
}

/// Vertices off the surface of the grid: is it that of another mesh, or of another place?
void warn_of_distance(const VoxelizedMesh& input, const std::string& file,
                      std::vector<std::string>& warnings) {
    GridStack finest = input.stack;
    finest.levels.resize(1);
    const LevelStack field(finest);
    const auto off = static_cast<std::size_t>(
        std::count_if(input.mesh.positions.begin(), input.mesh.positions.end(), [&](const Vec3d& p) {
            return is_finite(p) && std::fabs(field.map(input.frame.to_unit(p))) > 2.0f * field.resolution();
        }));
    if (off > input.mesh.vertex_count() / 100)
        warnings.push_back(
            fmt::format("{} of {} vertices are more than two voxels off the surface of {}: is it the "
                        "grid of this mesh?",
                        grouped(off), grouped(input.mesh.vertex_count()), file));
}

/// The stack in the frame of the mesh, as far as the radius, inside too where that is asked.
void take_grid(VoxelizedMesh& input, GridStack stack, const GridRequest& request, const std::string& file) {
    input.frame = frame_of(input.mesh.box());
    input.stack = reframed(std::move(stack), input.frame);
    input.radius = to_unit(parse_length(request.radius, "--radius"), input.frame.diagonal,
                           input.stack.levels.front().voxel);
    const float reach = input.stack.reach();
    if (request.inside && !input.stack.knows_inside())
        input.warnings.push_back(fmt::format(
            "{} knows too little of the inside for these attributes: it is voxelized again from its "
            "own surface; save the grid of a bake with them",
            file));
    else if (reach < std::min(input.radius, 1.0f))
        input.warnings.push_back(
            fmt::format("{} holds distances up to {:.4g}, less than the radius: coarser levels "
                        "are made from its surface; a band as wide as the radius needs none",
                        file, reach * input.frame.diagonal));
    input.stack = extend_levels(std::move(input.stack), input.radius, request.inside);
}

VoxelizedMesh read_grid_input(const BakeInputRequest& request, const GridRequest& grid,
                              nlohmann::ordered_json& seconds) {
    const bool meshed = request.grid.empty();
    const std::string& file = meshed ? request.input : request.grid;
    parse_length(grid.radius, "--radius"); // wrong ones are said before any work
    Stopwatch watch;
    VoxelizedMesh result;
    result.file = request.input;
    if (!meshed) {
        result.mesh = read_mesh(request.input);
        result.warnings = result.mesh.warnings;
    }
    GridStack stack = read_grids(file);
    seconds["read"] = watch.lap();
    try {
        if (meshed)
            result.mesh = mesh_zero_surface(stack, request.adaptivity);
        result.triangles = triangulate(result.mesh).triangles;
        take_grid(result, std::move(stack), grid, file);
    } catch (const InputError& error) {
        throw InputError(file + ": " + error.what());
    }
    if (!meshed)
        warn_of_distance(result, file, result.warnings);
    seconds["grid"] = watch.lap();
    return result;
}

}

void add_bake_input_options(CLI::App& verb, BakeInputRequest& request) {
    verb.add_option("--grid", request.grid, "Level set of the mesh (vdb), to be used instead of voxelizing")
        ->type_name("FILE");
    verb.add_option("--adaptivity", request.adaptivity,
                    "Of the mesh made from a grid: 0: all quads, to 1: large faces where it is flat")
        ->check(CLI::Range(0.0, 1.0).description(""))
        ->type_name("A")
        ->capture_default_str();
    verb.add_flag(
        "--self", request.self,
        "Each connected part of the mesh is occluded by itself alone, and by --occluder and --ground");
}

VoxelizedMesh read_bake_input(const BakeInputRequest& request, const GridRequest& grid, bool needs_grid,
                              const CommonOptions& common, nlohmann::ordered_json& seconds) {
    check(request, grid);
    const bool from_mesh = request.grid.empty() && extension(request.input) != ".vdb";
    if (request.self || (from_mesh && !needs_grid)) {
        VoxelizedMesh input = read_to_voxelize(request.input, grid, seconds);
        seconds["grid"] = 0.0;
        return input;
    }
    if (from_mesh)
        return read_and_voxelize(request.input, grid, common, seconds);
    return read_grid_input(request, grid, seconds);
}

}
