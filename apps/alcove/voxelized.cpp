#include "voxelized.h"

#include "length.h"

#include "alcove/base/detail/atomic_file.h"
#include "alcove/base/errors.h"
#include "alcove/mesh/read.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace alcove::cli {

SignChoice parse_sign(const std::string& text) {
    if (text == "auto")
        return SignChoice::automatic;
    if (text == "signed")
        return SignChoice::solid;
    if (text == "unsigned")
        return SignChoice::sheet;
    throw UsageError(fmt::format("--sign takes auto, signed or unsigned, not '{}'", text));
}

std::optional<Length> parse_voxel(const std::string& text) {
    if (text == "auto")
        return {};
    const Length voxel = parse_length(text, "--voxel");
    if (voxel.unit == Length::Unit::voxels)
        throw UsageError("--voxel is what vx stands for: give it as 0.2 (scene units) or 0.5%");
    if (std::isinf(voxel.value))
        throw UsageError("--voxel takes a finite length, not 'inf': write 0.2 (scene units) or 0.5%");
    return voxel;
}

void add_radius_option(CLI::App& verb, GridRequest& request, const std::string& description) {
    verb.add_option("--radius", request.radius, description)->type_name("LEN")->capture_default_str();
}

void add_grid_options(CLI::App& verb, GridRequest& request) {
    verb.add_option("--voxel", request.voxel,
                    "Edge of the finest voxel: 0.2, 0.5%, or auto (1/256 of the diagonal, "
                    "finer for small radii)")
        ->type_name("LEN")
        ->capture_default_str();
    verb.add_option("--sign", request.sign,
                    "auto: as the mesh is; signed: a solid; unsigned: open on both sides")
        ->type_name("SIGN")
        ->capture_default_str();
}

void GridFacts::include(const GridFacts& other) {
    voxel = std::max(voxel, other.voxel);
    levels = std::max(levels, other.levels);
    bytes = std::max(bytes, other.bytes);
    clustered = clustered || other.clustered;
    if (other.sign == Sign::sheet)
        sign = Sign::sheet;
}

std::string GridFacts::text() const {
    if (levels == 0)
        return "on the mesh itself";
    return fmt::format("as a {} of {} level{} from voxel {:.4g}{}", name_of(sign), levels,
                       levels == 1 ? "" : "s", voxel, clustered ? ", clustered to half of it" : "");
}

GridFacts facts_of(const GridStack& stack) {
    if (stack.levels.empty())
        return {};
    return {stack.levels.front().voxel * stack.frame.diagonal, stack.levels.size(), stack.bytes(), stack.sign,
            stack.clustered};
}

VoxelizedMesh read_to_voxelize(const std::string& input, const GridRequest& request,
                               nlohmann::ordered_json& seconds) {
    // What is wrong on the command line is said before any work.
    const Length radius = parse_length(request.radius, "--radius");
    const std::optional<Length> voxel = parse_voxel(request.voxel);
    if (!voxel && radius.unit == Length::Unit::voxels)
        throw UsageError(
            "--radius in vx needs a voxel of known size: give --voxel as 0.2 (scene units) or 0.5%");
    VoxelizedMesh result;
    result.file = input;
    GridOptions& grid = result.options.grid;
    result.options.sign = parse_sign(request.sign);
    grid.outer_band = request.band;
    grid.cluster = request.cluster;
    if (request.inside)
        grid.inner_band = request.band;

    Stopwatch watch;
    result.mesh = read_mesh(input);
    result.warnings = result.mesh.warnings;
    result.triangles = triangulate(result.mesh).triangles;
    result.frame = frame_of(result.mesh.box());
    grid.voxel = voxel ? to_unit(*voxel, result.frame.diagonal) : 0.0f;
    grid.radius = to_unit(radius, result.frame.diagonal, grid.voxel);
    result.radius = grid.radius;
    seconds["read"] = watch.lap();
    return result;
}

void make_stack(VoxelizedMesh& input, const CommonOptions& common) {
    ProgressMeter meter(common.progress_mode(), "voxelizing");
    VoxelizeOptions options = input.options;
    options.progress = std::ref(meter);
    try {
        input.stack = voxelize(input.mesh, input.triangles, options);
    } catch (const InputError& error) {
        throw InputError(input.file + ": " + error.what());
    } catch (const LimitError& error) {
        throw LimitError(input.file + ": " + error.what());
    }
    input.warnings.insert(input.warnings.end(), input.stack.warnings.begin(), input.stack.warnings.end());
}

VoxelizedMesh read_and_voxelize(const std::string& input, const GridRequest& request,
                                const CommonOptions& common, nlohmann::ordered_json& seconds) {
    VoxelizedMesh result = read_to_voxelize(input, request, seconds);
    Stopwatch watch;
    make_stack(result, common);
    seconds["grid"] = watch.lap();
    return result;
}

void check_grid_output(const std::string& file) {
    if (extension(file) != ".vdb")
        throw UsageError(file + ": grids are written as .vdb; name the output so");
    const AtomicFile probe(file);
}

std::string_view name_of(Sign sign) {
    return sign == Sign::solid ? "solid" : "sheet";
}

}
