#include "baking.h"
#include "time_estimate.h"

#include "alcove/bake/detail/pilot.h"
#include "alcove/grid/detail/plan.h"
#include "alcove/mesh/detail/parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace alcove::cli {
namespace {

constexpr float largest_voxel_of_part = 1.0f / 32.0f;

/// The request for the whole, in the unit space of a part.
VoxelizeOptions options_of_part(const VoxelizeOptions& whole, float scale) {
    VoxelizeOptions options = whole;
    options.grid.radius *= scale;
    options.grid.voxel = std::min(options.grid.voxel * scale, largest_voxel_of_part);
    return options;
}

/// With a share of the surfels of the whole.
PilotOptions pilot_of_part(PilotOptions whole, std::size_t part_surfels, std::size_t whole_surfels) {
    whole.surfels = (whole.surfels * part_surfels + whole_surfels - 1) / whole_surfels;
    return whole;
}

/// What pilots of parts say of the whole.
class PooledError {
  public:
    void add(double rmse, std::size_t surfels) {
        squares_ += rmse * rmse * static_cast<double>(surfels);
        surfels_ += surfels;
    }
    std::optional<double> rmse() const {
        if (surfels_ == 0)
            return {};
        return std::sqrt(squares_ / static_cast<double>(surfels_));
    }

  private:
    double squares_ = 0.0;
    std::size_t surfels_ = 0;
};

bool has_area(const std::vector<Triangle>& triangles, const Mesh& mesh) {
    const std::vector<Vec3> normals = area_weighted_normals(mesh, triangles);
    return std::any_of(normals.begin(), normals.end(), [](const Vec3& n) { return n != Vec3(0.0f); });
}

}

Baked bake_parts(VoxelizedMesh& input, const Surroundings& surroundings, const BakeTask& task,
                 const Progress& progress) {
    constexpr std::size_t most_warnings = 3;
    const bool with_pilot = task.planning.pilot && task.wanted.has(Channel::ao);
    Needs needs = task.needs();
    needs.rays = needs.rays || with_pilot;
    Baked result{choice_of(*task.method, task.settings), {}, {}};
    PooledError error;
    for (const ChannelInfo& channel : channels)
        if (task.wanted.has(channel.channel))
            result.values[channel.channel].assign(input.mesh.vertex_count() * channel.components,
                                                  channel.missing);
    std::vector<char> baked(input.mesh.vertex_count(), 0);
    const std::vector<MeshPart> parts = split_parts(input.mesh);
    std::size_t finished = 0, warned = 0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        const Mesh& mesh = parts[p].mesh;
        const std::vector<std::uint32_t>& vertices = parts[p].vertices;
        const Frame frame = frame_of(mesh.box());
        const auto scale = static_cast<float>(input.frame.diagonal / frame.diagonal);
        const std::vector<Triangle> triangles = triangulate(mesh).triangles;
        if (!has_area(triangles, mesh))
            continue;
        Stopwatch watch;
        GridStack stack;
        if (needs.field)
            stack = voxelize(mesh, triangles, options_of_part(input.options, scale));
        const Occluders occluders = surroundings.around(mesh, triangles, stack, frame, needs);
        result.grid_seconds += watch.lap();
        result.grid.include(facts_of(stack));
        const auto warn = [&](const std::string& warning) {
            if (++warned <= most_warnings)
                input.warnings.push_back(fmt::format("part {} of {}: {}", p + 1, parts.size(), warning));
        };
        for (const std::string& warning : stack.warnings)
            warn(warning);

        Settings of_part = task.settings;
        of_part.radius = input.radius * scale;
        const std::vector<Surfel> surfels = make_surfels(mesh, triangles, frame, task.normals);
        refuse_late_bake(surfels, occluders, *task.method, of_part, task.wanted);
        ChannelValues values =
            bake_channels(surfels, occluders, *task.method, of_part, task.wanted, [&](double done) {
                progress((static_cast<double>(finished) + done * static_cast<double>(vertices.size())) /
                         static_cast<double>(input.mesh.vertex_count()));
            });
        if (with_pilot) {
            watch.lap();
            const Pilot pilot(
                surfels, occluders.rays(), of_part.radius,
                pilot_of_part(pilot_beside(result.choice.rays()), surfels.size(), input.mesh.vertex_count()));
            if (!pilot.empty()) {
                const double rmse = pilot.rmse(values[Channel::ao]);
                error.add(rmse, surfels.size());
                const std::string warning =
                    thin_wall_warning(rmse, *task.method, surfels, occluders, frame.diagonal, [&] {
                        return finest_voxel(surface_size(mesh, triangles), triangles.size(),
                                            input.options.grid);
                    });
                if (!warning.empty())
                    warn(warning);
            }
            result.pilot_seconds += watch.lap();
        }
        for (float& thickness : values[Channel::thickness])
            thickness /= scale;
        finished += vertices.size();
        for (std::size_t i = 0; i < vertices.size(); ++i)
            if (!std::exchange(baked[vertices[i]], 1))
                for (const ChannelInfo& channel : channels)
                    if (task.wanted.has(channel.channel))
                        std::copy_n(values[channel.channel].data() + i * channel.components,
                                    channel.components,
                                    result.values[channel.channel].data() + vertices[i] * channel.components);
    }
    if (warned > most_warnings)
        input.warnings.push_back(fmt::format("{} more warnings of parts", warned - most_warnings));
    result.rmse = error.rmse();
    return result;
}

}
