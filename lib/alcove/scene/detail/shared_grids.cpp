#include "alcove/scene/detail/shared_grids.h"

#include "alcove/base/types.h"
#include "alcove/scene/detail/missing_walls.h"

#include <fmt/format.h>

#include <algorithm>

namespace alcove {
namespace {

// Measured: about 40 % of the memory needed to build a grid remains in use by the field.
constexpr double kept = 0.4;
// Measured: the field of a level set takes 1.5 times the memory of its OpenVDB grid, so 2.5 times with the grid.
constexpr double bytes_over_grid = 2.5;
// Measured: the memory that even the smallest level takes.
constexpr double bytes_per_level = 2e5;

const MeshShape* mesh_of(const LoadedShape& loaded) {
    return std::get_if<MeshShape>(&loaded.object->shape);
}

const GridShape* grid_of(const LoadedShape& loaded) {
    return std::get_if<GridShape>(&loaded.object->shape);
}

/// Returns the result of `work`. Adds the name of the file to the messages of its exceptions.
template <class Work>
decltype(auto) naming(const std::filesystem::path& file, const Work& work) {
    try {
        return work();
    } catch (const InputError& error) {
        throw InputError(file.string() + ": " + error.what());
    } catch (const LimitError& error) {
        throw LimitError(file.string() + ": " + error.what());
    }
}

}

SharedGrids::SharedGrids(const std::vector<LoadedShape>& shapes, const GridContext& context, MemoryEstimate& memory)
    : context_(context), limit_(memory.limit()), limit_of_automatic_(memory.limit()) {
    std::vector<const LoadedShape*> automatic; // their voxels may get coarser
    double planned = 0.0;                      // bytes of the automatic grids
    std::pair<double, std::string> largest{};  // most bytes of a grid while it is built, and its file
    for_each_shape(shapes, [&](const LoadedShape& loaded) {
        if ((!mesh_of(loaded) && !grid_of(loaded)) || entries_[key_of(loaded)].users++ > 0)
            return;
        if (const GridShape* grid = grid_of(loaded)) {
            memory.add(grid->file.string(), bytes_over_grid * static_cast<double>(loaded.stack.bytes()));
            return;
        }
        const MeshShape& mesh = *mesh_of(loaded);
        const LevelPlan plan = plan_of(loaded);
        memory.add(mesh.file.string(), kept * plan.bytes + bytes_per_level * plan.levels);
        largest = std::max(largest, {plan.bytes, mesh.file.string()});
        if (mesh.voxel)
            return;
        automatic.push_back(&loaded);
        planned += kept * plan.bytes;
    });
    if (largest.first > 0.0)
        memory.add(largest.second, (1.0 - kept) * largest.first);
    if (memory.left() < 0.0)
        share_what_is_left(automatic, planned, memory);
}

/// Gives each grid with an automatic voxel an equal part of the memory that the rest of the scene leaves free.
void SharedGrids::share_what_is_left(const std::vector<const LoadedShape*>& automatic, double planned,
                                     const MemoryEstimate& memory) {
    limit_of_automatic_ = (memory.left() + planned) / (kept * static_cast<double>(automatic.size()));
    if (automatic.empty() || !(limit_of_automatic_ > 0.0))
        memory.refuse();
    for (const LoadedShape* loaded : automatic)
        try {
            plan_of(*loaded);
        } catch (const LimitError&) { // no voxel fits
            memory.refuse();
        }
}

LevelPlan SharedGrids::plan_of(const LoadedShape& loaded) const {
    return naming(mesh_of(loaded)->file,
                  [&] { return plan_levels(loaded.mesh->mesh, loaded.mesh->triangles, options_of(loaded).grid); });
}

float SharedGrids::in_unit_of(const Frame& own, float length, const LoadedShape& loaded) const {
    return static_cast<float>(double(length) * context_.frame.diagonal / (own.diagonal * loaded.pose.scale));
}

VoxelizeOptions SharedGrids::options_of(const LoadedShape& loaded) const {
    const MeshShape& shape = *mesh_of(loaded);
    const Frame own = frame_of(loaded.mesh->mesh.box());
    VoxelizeOptions options;
    options.sign = shape.sign;
    const float radius = in_unit_of(own, context_.radius, loaded);
    options.grid.radius = std::max(radius, in_unit_of(own, loaded.reach, loaded));
    options.grid.largest_voxel = chosen_voxel(radius, options.grid.largest_voxel);
    options.grid.memory_limit = shape.voxel ? limit_ : limit_of_automatic_;
    if (shape.voxel)
        options.grid.voxel = shape.voxel->to_unit(own.diagonal);
    if (loaded.inside)
        options.grid.inner_band = options.grid.outer_band;
    options.progress = context_.progress;
    return options;
}

SharedGrids::Key SharedGrids::key_of(const LoadedShape& loaded) const {
    Key key;
    key.inside = loaded.inside;
    if (grid_of(loaded)) {
        key.file = loaded.stack.levels.front().grid.get();
        key.reach = in_unit_of(loaded.stack.frame, loaded.reach, loaded);
        return key;
    }
    const VoxelizeOptions options = naming(mesh_of(loaded)->file, [&] { return options_of(loaded); });
    key.file = loaded.mesh.get();
    key.sign = options.sign;
    key.largest_voxel = options.grid.largest_voxel;
    key.reach = options.grid.radius;
    key.voxel = options.grid.voxel;
    return key;
}

AnyField SharedGrids::field(LoadedShape& loaded) {
    Entry& entry = entries_.at(key_of(loaded));
    const Pose& pose = loaded.pose;
    if (entry.field) {
        loaded.stack = entry.stack;
        return posed(*entry.field, loaded.stack.frame, pose, context_.frame);
    }
    mesh_of(loaded) ? voxelize_mesh(loaded) : extend_grid(loaded);
    const bool is_placed = entry.users == 1 && pose.rotation == glm::dmat3(1.0);
    // If only one object uses the field, and without a rotation, the grid itself is placed, which saves transforming
    // every point.
    entry.field.emplace(is_placed ? reframed(loaded.stack, {(context_.frame.center - pose.translation) / pose.scale,
                                                            context_.frame.diagonal / pose.scale})
                                  : loaded.stack);
    AnyField field = is_placed ? AnyField(*entry.field) : posed(*entry.field, loaded.stack.frame, pose, context_.frame);
    if (mesh_of(loaded))
        warn_of_mesh(loaded, field);
    for (LevelSet& level : loaded.stack.levels)
        level.grid.reset(); // the field has its own copy
    entry.stack = loaded.stack;
    return field;
}

void SharedGrids::voxelize_mesh(LoadedShape& loaded) const {
    loaded.stack = naming(mesh_of(loaded)->file,
                          [&] { return voxelize(loaded.mesh->mesh, loaded.mesh->triangles, options_of(loaded)); });
}

void SharedGrids::warn_of_mesh(LoadedShape& loaded, const AnyField& field) const {
    const std::vector<std::string>& warnings = loaded.stack.warnings;
    loaded.warnings.insert(loaded.warnings.end(), warnings.begin(), warnings.end());
    if (std::string missing = missing_walls(loaded, field, context_.frame, options_of(loaded).grid); !missing.empty())
        loaded.warnings.push_back(std::move(missing));
}

void SharedGrids::extend_grid(LoadedShape& loaded) const {
    const std::filesystem::path& file = grid_of(loaded)->file;
    const float reach = loaded.stack.reach();
    const float wanted = std::min(in_unit_of(loaded.stack.frame, loaded.reach, loaded), 1.0f);
    if (reach >= wanted && !loaded.inside)
        return;
    if (loaded.stack.sign == Sign::sheet) {
        if (reach >= wanted)
            return;
        loaded.warnings.push_back(
            fmt::format("{} holds distances up to {:.4g}, less than occlusion and shadows need: larger ones are "
                        "estimated; voxelize its mesh with a larger --radius",
                        file.string(), reach * loaded.stack.frame.diagonal));
        return;
    }
    loaded.stack =
        naming(file, [&] { return extend_levels(std::move(loaded.stack), std::max(wanted, reach), loaded.inside); });
}

}
