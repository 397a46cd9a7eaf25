#include "alcove/bake/detail/target_occluders.h"

#include "alcove/base/detail/stopwatch.h"
#include "alcove/base/types.h"

#include <algorithm>

namespace alcove {

GridSummary summary_of(const GridStack& stack) {
    if (stack.levels.empty())
        return {};
    return {stack.levels.front().voxel * stack.frame.diagonal, stack.levels.size(), stack.bytes(), stack.sign,
            stack.clustered};
}

const RaySurface& TargetOccluders::rays() {
    if (!rays_) {
        Stopwatch watch;
        rays_ = surroundings_.rays_around({target_.mesh.positions, target_.triangles, target_.frame});
        seconds_ += watch.lap();
    }
    return *rays_;
}

const AnyField& TargetOccluders::field(float largest_voxel) {
    const float key = target_.grid ? 0.0f : largest_voxel;
    auto found = fields_.find(key);
    if (found == fields_.end()) {
        Stopwatch watch;
        found = fields_.emplace(key, build(largest_voxel)).first;
        seconds_ += watch.lap();
    }
    current_ = &found->second;
    return current_->field;
}

Occluders TargetOccluders::get(OccluderNeeds needs, float largest_voxel) {
    if (!needs.rays)
        return field(largest_voxel);
    if (!needs.field) {
        current_ = nullptr;
        return rays();
    }
    return {field(largest_voxel), rays()};
}

GridStack TargetOccluders::take_stack(float largest_voxel) {
    field(largest_voxel);
    return std::move(current_->stack);
}

TargetOccluders::BuiltField TargetOccluders::build(float largest_voxel) {
    std::vector<std::string> warnings;
    GridStack own;
    if (!target_.grid) {
        VoxelizeOptions options = target_.voxelizing;
        options.grid.largest_voxel = largest_voxel;
        // Larger voxels get no partial levels, because the planner chooses them only where they suffice.
        options.grid.refine = largest_voxel <= GridOptions{}.largest_voxel;
        if (progress_)
            options.progress = [&](double done) { progress_("voxelizing", done); };
        own = voxelize(target_.mesh, target_.triangles, options);
        warnings = own.warnings;
    }
    const GridStack& stack = target_.grid ? *target_.grid : own;
    surroundings_.voxelize(target_.occluder_voxel.value_or(stack.levels.front().voxel * stack.frame.diagonal),
                           warnings);
    GridSummary summary = summary_of(stack);
    summary.bytes += surroundings_.bytes();
    AnyField field = surroundings_.field_around(stack, target_.frame);
    return {std::move(field), summary, keep_grid_ ? stack : GridStack{}, std::move(warnings)};
}

}
