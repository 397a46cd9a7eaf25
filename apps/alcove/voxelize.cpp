#include "inputs.h"
#include "options.h"
#include "weld.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/detail/stopwatch.h"
#include "alcove/base/parallel.h"
#include "alcove/mesh/detail/gaps.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/vdb/vdb_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <memory>

namespace alcove::cli {
namespace {

constexpr const char* lattice_forms = "0.1 (scene units) or a .vdb file";

struct VoxelizeVerb {
    CommonOptions common;
    Length radius = "10%";
    std::optional<Length> voxel, weld, point_size;
    std::string lattice; ///< a length or a grid; empty: none
    VoxelizeOptions voxelizing;
    std::string input, output;
};

Length lattice_length(const std::string& text) {
    const Length length = length_without_vx(text, lattice_forms);
    if (length.unit != Length::Unit::scene || std::isinf(length.value))
        throw InputError(fmt::format("takes {}, not '{}'", lattice_forms, text));
    return length;
}

/// The lattice of a voxel length, or of the finest level set of a .vdb.
std::optional<Lattice> lattice_of(const std::string& text) {
    if (text.empty())
        return {};
    return is_grid(text) ? read_lattice(text) : Lattice{lattice_length(text).value};
}

GridStack voxelized(const VoxelizeVerb& verb, const Mesh& mesh, std::span<const Triangle> triangles,
                    const std::optional<Lattice>& lattice) {
    VoxelizeOptions options = verb.voxelizing;
    const double diagonal = frame_of(mesh.box()).diagonal;
    options.grid.lattice = lattice;
    const std::optional<Length> voxel = lattice ? Length(lattice->voxel) : verb.voxel;
    options.grid.voxel = voxel ? as_usage([&] { return voxel->to_unit(diagonal); }) : 0.0f;
    options.grid.radius = as_usage([&] { return verb.radius.to_unit(diagonal, options.grid.voxel); });
    ProgressMeter meter(verb.common.progress_mode(), "voxelizing");
    options.progress = std::ref(meter);
    try {
        return voxelize(mesh, triangles, options);
    } catch (const InputError& error) {
        throw InputError(verb.input + ": " + error.what());
    } catch (const LimitError& error) {
        throw LimitError(verb.input + ": " + error.what());
    }
}

void run(const VoxelizeVerb& verb) {
    const ThreadLimit limit(verb.common.threads);
    check_grid_output(verb.output);
    if (!verb.voxel && verb.lattice.empty() && verb.radius.unit == Length::Unit::voxels)
        throw UsageError("--radius in vx needs a voxel of known size: give --voxel as 0.2 (scene units) or 0.5%");
    const std::optional<Lattice> lattice = lattice_of(verb.lattice);
    nlohmann::ordered_json seconds;
    Stopwatch watch;
    Mesh file = read_welded(verb.input, verb.weld);
    const bool is_cloud = file.face_count() == 0;
    const Mesh mesh = with_surface(std::move(file), {verb.point_size});
    seconds["read"] = watch.lap();
    const std::vector<Triangle> triangles = triangulate(mesh).triangles;
    const GridStack stack = voxelized(verb, mesh, triangles, lattice);
    seconds["grid"] = watch.lap();
    write_grids(stack, verb.output);
    seconds["write"] = watch.lap();

    std::vector<std::string> warnings = mesh.warnings;
    if (const Gaps gaps = find_gaps(mesh, triangles); !is_cloud && gaps.closable > 0)
        warnings.push_back(gaps.advice());
    warnings.insert(warnings.end(), stack.warnings.begin(), stack.warnings.end());
    print_warnings(warnings, verb.common);
    const auto facts_of = [](const LevelSet& level, double voxel) {
        return nlohmann::ordered_json{{"voxel", voxel},
                                      {"band", level.outer_band},
                                      {"active_voxels", level.active_voxels},
                                      {"bytes", level.bytes}};
    };
    auto levels = nlohmann::ordered_json::array(), partial = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < stack.levels.size(); ++i)
        levels.push_back(facts_of(stack.levels[i], stack.scene_voxel(i)));
    for (const LevelSet& level : stack.partial)
        partial.push_back(facts_of(level, level.voxel * stack.frame.diagonal));
    if (verb.common.json)
        print_json({{"input", verb.input},
                    {"output", verb.output},
                    {"vertices", mesh.vertex_count()},
                    {"faces", mesh.face_count()},
                    {"sign", name_of(stack.sign)},
                    {"levels", levels},
                    {"partial_levels", partial},
                    {"grid_bytes", stack.bytes()},
                    {"seconds", seconds},
                    {"peak_rss_bytes", peak_resident_bytes()},
                    {"warnings", warnings}});
    else if (!verb.common.quiet) {
        const auto say_level = [&](const std::string& name, const nlohmann::ordered_json& level,
                                   std::string_view kind) {
            say(fmt::format("{}: {}: voxel {:.4g}, {} active voxels, {}", verb.output, name,
                            level["voxel"].get<double>(), grouped(level["active_voxels"]), kind));
        };
        for (const auto& level : partial)
            say_level("partial level", level, "near thin walls and narrow gaps only");
        for (std::size_t i = 0; i < levels.size(); ++i)
            say_level(fmt::format("level {}", i + 1), levels[i], name_of(stack.sign));
    }
}

}

void add_voxelize(CLI::App& program) {
    auto* app = program.add_subcommand("voxelize", "Turn a mesh into narrow-band level sets");
    auto verb = std::make_shared<VoxelizeVerb>();
    app->add_option("input", verb->input, "Mesh (ply, obj, off, stl, glb, gltf), or points with normals (ply)")
        ->required();
    app->add_option("-o,--output", verb->output, "Grid to write (vdb)")->required();
    add_radius_option(*app, verb->radius,
                      "Maximum distance to store; levels are added, each with twice the voxel size of the one before, "
                      "until they reach it");
    add_grid_options(*app, verb->voxel, verb->voxelizing.sign);
    app->add_option(
           "--lattice", verb->lattice,
           "Align the voxels with those of other grids, so that the grids can be combined. LEN: put voxel centres at "
           "whole multiples of LEN from the origin; FILE: at the centres of the finest voxels of that .vdb")
        ->check(parsable([](const std::string& text) {
            if (!is_grid(text))
                lattice_length(text);
        }))
        ->excludes("--voxel")
        ->type_name("LEN|FILE");
    app->add_option("--band", verb->voxelizing.grid.outer_band,
                    "Width of the band outside the surface on each level, in voxels")
        ->check(CLI::Range(3.0, 100.0).description(""))
        ->type_name("N")
        ->capture_default_str();
    add_weld_option(*app, verb->weld);
    add_point_size(*app, verb->point_size);
    add_common_options(*app, verb->common);
    app->footer("Examples:\n"
                "  alcove voxelize scan.ply -o scan.vdb --voxel 0.2% --radius 20%\n"
                "  alcove voxelize wall.ply -o wall.vdb --lattice 0.1\n"
                "  alcove voxelize door.ply -o door.vdb --lattice wall.vdb\n");
    app->callback([verb] { run(*verb); });
}

}
