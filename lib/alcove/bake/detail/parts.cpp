#include "alcove/bake/detail/parts.h"

#include "alcove/base/detail/stopwatch.h"
#include "alcove/mesh/detail/parts.h"
#include "alcove/mesh/triangulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace alcove {
namespace {

constexpr float largest_voxel_of_part = 1.0f / 32.0f;

/// The options of the whole mesh, converted to the unit space of a part.
VoxelizeOptions options_of_part(const VoxelizeOptions& whole, float scale) {
    VoxelizeOptions options = whole;
    options.grid.radius *= scale;
    options.grid.voxel = std::min(options.grid.voxel * scale, largest_voxel_of_part);
    return options;
}

bool has_area(const BakeTarget& target) {
    const std::vector<Vec3> normals = angle_weighted_normals(target.mesh, target.triangles);
    return std::any_of(normals.begin(), normals.end(), [](const Vec3& n) { return n != Vec3(0.0f); });
}

/// Refuses to bake the remaining parts if they would clearly exceed the deadline, judging by the finished parts.
/// Considers both the number of parts and the number of surfels, because the grid of a small part takes as long as that
/// of a large one.
class TimeOfParts {
  public:
    TimeOfParts(const BakeTask& task, std::size_t parts, std::size_t surfels)
        : task_(task), parts_(static_cast<double>(parts)), surfels_(static_cast<double>(surfels)) {}

    void finish_part(std::size_t surfels) {
        finished_parts_ += 1.0;
        finished_surfels_ += static_cast<double>(surfels);
        spent_ += watch_.lap();
        const double in_all = std::min(parts_ / finished_parts_, surfels_ / finished_surfels_);
        task_.deadline.check(spent_ * (in_all - 1.0), [&](double) -> std::string {
            return task_.method ? "a faster method than " + std::string(task_.method->name) : "";
        });
    }

  private:
    const BakeTask& task_;
    double parts_, surfels_, finished_parts_ = 0.0, finished_surfels_ = 0.0, spent_ = 0.0;
    Stopwatch watch_;
};

/// Combines the results of the parts.
class WholeResult {
  public:
    WholeResult(const BakeTarget& whole, const BakeTask& task)
        : task_(task), scale_(whole.frame.diagonal), taken_(whole.surfels.size(), 0) {
        for (const ChannelInfo& channel : channels)
            if (task.attributes.has(channel.channel))
                result_.values[channel.channel].assign(whole.surfels.size() * channel.components, channel.missing);
        result_.choice = choose(task.method ? *task.method : find_method("exact"));
    }

    /// `vertices`: for each surfel of the part, its vertex in the whole mesh.
    void add(TargetResult part, std::span<const std::uint32_t> vertices, const Frame& frame, const std::string& name) {
        const auto to_whole = static_cast<float>(frame.diagonal / scale_);
        for (float& thickness : part.values[Channel::thickness])
            thickness *= to_whole;
        for (std::size_t i = 0; i < vertices.size(); ++i)
            if (!std::exchange(taken_[vertices[i]], 1))
                for (const ChannelInfo& channel : channels)
                    if (task_.attributes.has(channel.channel))
                        std::copy_n(part.values[channel.channel].data() + i * channel.components, channel.components,
                                    result_.values[channel.channel].data() + vertices[i] * channel.components);
        if (part.rmse) {
            squares_ += *part.rmse * *part.rmse * static_cast<double>(vertices.size());
            measured_ += vertices.size();
        }
        include(part.grid);
        result_.seconds.grid += part.seconds.grid;
        result_.seconds.pilot += part.seconds.pilot;
        result_.seconds.occlusion += part.seconds.occlusion;
        if (!part.reason.empty())
            result_.reason = part.reason;
        surfels_by_[part.choice.label()].second += vertices.size();
        surfels_by_[part.choice.label()].first = part.choice;
        for (const std::string& warning : part.warnings) {
            constexpr std::size_t max_warnings = 3;
            if (++warned_ <= max_warnings)
                result_.warnings.push_back(fmt::format("{}: {}", name, warning));
            else
                ++omitted_;
        }
    }

    TargetResult finish() {
        if (omitted_ > 0)
            result_.warnings.push_back(fmt::format("{} more warnings about parts", omitted_));
        if (measured_ > 0)
            result_.rmse = std::sqrt(squares_ / static_cast<double>(measured_));
        std::size_t most = 0;
        for (const auto& [label, by] : surfels_by_)
            if (by.second > most) {
                most = by.second;
                result_.choice = by.first; // the choice that most surfels have
            }
        return std::move(result_);
    }

  private:
    void include(const GridSummary& grid) {
        GridSummary& all = result_.grid;
        all.voxel = std::max(all.voxel, grid.voxel);
        all.levels = std::max(all.levels, grid.levels);
        all.bytes = std::max(all.bytes, grid.bytes);
        all.clustered = all.clustered || grid.clustered;
        if (grid.sign == Sign::sheet)
            all.sign = Sign::sheet;
    }

    const BakeTask& task_;
    double scale_;
    TargetResult result_;
    std::vector<char> taken_;
    double squares_ = 0.0;
    std::size_t measured_ = 0, warned_ = 0, omitted_ = 0;
    std::map<std::string, std::pair<MethodChoice, std::size_t>> surfels_by_;
};

}

TargetResult bake_parts(const BakeTarget& whole, const BakeTask& task, NormalSource normals, Surroundings& surroundings,
                        const BakeProgress& progress) {
    WholeResult result(whole, task);
    const std::vector<MeshPart> parts = split_parts(whole.mesh);
    const auto all = static_cast<double>(whole.surfels.size());
    TimeOfParts time(task, parts.size(), whole.surfels.size());
    std::size_t finished = 0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        const Mesh& mesh = parts[p].mesh;
        const Frame frame = frame_of(mesh.box());
        const auto scale = static_cast<float>(whole.frame.diagonal / frame.diagonal);
        BakeTarget target{mesh, triangulate(mesh).triangles, frame,
                          {},   whole.radius * scale,        options_of_part(whole.voxelizing, scale)};
        if (!has_area(target))
            continue;
        target.surfels = make_surfels(mesh, target.triangles, frame, normals);
        target.share = static_cast<double>(target.surfels.size()) / all;
        target.occluder_voxel = double(whole.voxelizing.grid.voxel) * whole.frame.diagonal;
        constexpr std::size_t min_surfels = 64;
        target.pilot_share.surfels =
            std::max(min_surfels, (target.pilot_share.surfels * target.surfels.size() + whole.surfels.size() - 1) /
                                      whole.surfels.size());
        BakeProgress of_whole;
        if (progress)
            of_whole = [&](std::string_view work, double done) {
                progress(work,
                         (static_cast<double>(finished) + done * static_cast<double>(target.surfels.size())) / all);
            };
        result.add(bake_target(target, task, surroundings, of_whole), parts[p].vertices, frame,
                   fmt::format("part {} of {}", p + 1, parts.size()));
        finished += parts[p].vertices.size();
        time.finish_part(parts[p].vertices.size());
    }
    return result.finish();
}

}
