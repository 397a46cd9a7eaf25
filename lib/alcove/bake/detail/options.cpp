#include "alcove/bake/detail/options.h"

#include "alcove/base/types.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

void require(bool holds, const std::string& otherwise) {
    if (!holds)
        throw InputError(otherwise);
}

/// Whether the numbers of rays and samples are fixed: a method is named without an error, or there is no ao for which
/// an error could be met.
bool is_fixed(const BakeOptions& options) {
    return !options.attributes.has(Channel::ao) || (!options.method.empty() && !options.error);
}

const Method& named_method(const BakeOptions& options) {
    return find_method(options.method.empty() ? "guided" : options.method);
}

}

void check(const BakeOptions& options) {
    task_of(options);
    require(!options.attributes.empty(), "--attributes is empty: name at least one, such as ao");
    require(!options.error || options.attributes.has(Channel::ao),
            "--error applies only to ao: add ao to --attributes, or leave out --error");
    require(!options.error || (*options.error >= 1e-3 && *options.error < 1.0),
            fmt::format("--error takes an RMSE of at least 0.001 and below 1, not {:g}", options.error.value_or(0.0)));
    require(options.parameters.empty() || !options.method.empty(),
            "--rays, --samples and --set need a --method: without one, the planner chooses them");
    require(is_fixed(options) || std::none_of(options.parameters.begin(), options.parameters.end(),
                                              [&](const auto& parameter) {
                                                  return parameter.first ==
                                                         parameter_of(named_method(options).samples_are);
                                              }),
            fmt::format("--{} cannot be combined with --error or --quality, which determine it",
                        parameter_of(named_method(options).samples_are)));
    require(options.pilot || is_fixed(options),
            "--no-pilot needs a --method without --error: the planner needs the pilot");
    require(options.radius.value > 0.0, "--radius takes a positive length, such as 0.2 (scene units), 10% or inf");
    require(options.up != Vec3d(0.0), "--up takes a direction, not 0,0,0: use 0,1,0 or 0,0,1");
    require(!options.time_limit || *options.time_limit > 0.0, "--time-limit takes a number of seconds above 0");
    require(!options.voxel || options.voxel->unit != Length::Unit::voxels,
            "--voxel defines the unit vx: give it as 0.2 (scene units) or 0.5%");
    require(!options.voxel || std::isfinite(options.voxel->value),
            "--voxel takes a finite length: write 0.2 (scene units) or 0.5%");
    require(!options.weld || (options.weld->unit != Length::Unit::voxels && std::isfinite(options.weld->value)),
            "--weld takes a finite length: write 0.2 (scene units) or 0.001%");
    require(!options.point_size ||
                (options.point_size->unit != Length::Unit::voxels && std::isfinite(options.point_size->value)),
            "--point-size takes a finite length: write 0.2 (scene units) or 0.1%");
    require(options.radius.unit != Length::Unit::voxels || options.voxel || options.grid,
            "--radius in vx needs a voxel of known size: give --voxel as 0.2 (scene units) or 0.5%");
    require(!options.grid || (!options.voxel && options.sign == SignChoice::automatic),
            "--voxel and --sign apply to voxelizing, but there is a grid already: leave them out");
    require(
        !options.self || (options.faces.no_occlude.empty() && !options.faces.opaque_only),
        "--self lets each part occlude only itself, so --no-occlude and --opaque-only have no effect: leave out one");
    require(!options.self || !options.grid,
            "--self needs a grid for each part, but the given grid contains all parts: leave out one of them");
    require(!options.self || !options.keep_grid,
            "--self uses a grid for each part, but --write-grid writes one grid of all parts: leave out one of them");
}

BakeTask task_of(const BakeOptions& options) {
    BakeTask task;
    task.attributes = options.attributes;
    task.via = options.via;
    task.seed = options.seed;
    task.pilot = options.pilot;
    task.keep_grid = options.keep_grid;
    task.deadline = Deadline(options.time_limit);
    const bool fixed = is_fixed(options);
    if (!fixed)
        task.error = task.target_error = options.error.value_or(rmse_of(options.quality));
    if (fixed || !options.method.empty()) {
        const std::vector<const Method*> needed = methods_for(named_method(options), options.attributes);
        task.method = needed.empty() ? &named_method(options) : needed.front();
        for (const auto& parameter : options.parameters)
            task.settings.parameters.push_back(parameter);
        if (options.seed != 0)
            task.settings.parameters.emplace_back("seed", options.seed);
        check_settings(needed, task.settings);
    } else if (options.attributes.has(Channel::ao_short) || options.attributes.has(Channel::ao_long)) {
        methods_for(find_method("exact"), options.attributes); // throws; the message names a suitable method
    }
    return task;
}

VoxelizeOptions voxelizing_of(const BakeOptions& options, const Frame& frame) {
    VoxelizeOptions voxelizing;
    voxelizing.sign = options.sign;
    GridOptions& grid = voxelizing.grid;
    grid.cluster = !options.keep_grid; // grids to keep are built from all triangles
    if (std::any_of(channels.begin(), channels.end(), [&](const ChannelInfo& channel) {
            return channel.inside && options.attributes.has(channel.channel);
        }))
        grid.inner_band = grid.outer_band;
    grid.voxel = options.voxel ? options.voxel->to_unit(frame.diagonal) : 0.0f;
    grid.radius = radius_of(options, frame, voxelizing);
    return voxelizing;
}

float radius_of(const BakeOptions& options, const Frame& frame, const VoxelizeOptions& voxelizing) {
    const float voxel =
        options.grid
            ? static_cast<float>(options.grid->levels.front().voxel * options.grid->frame.diagonal / frame.diagonal)
            : voxelizing.grid.voxel;
    return options.radius.to_unit(frame.diagonal, voxel);
}

}
