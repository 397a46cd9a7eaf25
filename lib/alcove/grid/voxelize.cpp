#include "alcove/grid/voxelize.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/parallel.h"
#include "alcove/base/types.h"
#include "alcove/grid/detail/clustered.h"
#include "alcove/grid/detail/duplicate_faces.h"
#include "alcove/grid/detail/level_set.h"
#include "alcove/grid/detail/plan.h"
#include "alcove/grid/detail/sign.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace alcove {
namespace {

/// The position of index (0, 0, 0) on all levels. All bands have positive indices, so that an OpenVDB tree has one node
/// below its root rather than eight, each a quarter of a megabyte.
Vec3 origin_of(const Box& box, const Frame& frame, const LevelPlan& plan) {
    const float margin = std::ldexp(plan.voxel, plan.levels - 1) * (std::ceil(plan.outer_band) + 2.0f);
    return frame.to_unit(box.min) - margin;
}

/// Positions in index space: voxels of the finest level.
HugeVector<Vec3d> index_positions(const Mesh& mesh, const Frame& frame, const Vec3d& origin, double voxel) {
    HugeVector<Vec3d> positions(mesh.positions.size());
    parallel_for(positions.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v)
            positions[v] = ((mesh.positions[v] - frame.center) / frame.diagonal - origin) / voxel;
    });
    return positions;
}

TriangleTree tree_of(const Surface& surface) {
    const FragmentLeaves fragments(surface.positions, surface.triangles);
    if (fragments.count() == 0)
        throw InputError("the mesh has no face with nonzero area: there is no surface to occlude anything");
    return TriangleTree(fragments);
}

}

GridStack voxelize(const Mesh& mesh, std::span<const Triangle> triangles, const VoxelizeOptions& options) {
    const LevelPlan plan = plan_levels(mesh, triangles, options.grid);
    GridStack stack;
    const Box box = mesh.box();
    stack.frame = frame_of(box);
    stack.value_unit = value_unit_of(stack.frame);
    const Vec3 origin = origin_of(box, stack.frame, plan);
    const HugeVector<Vec3d> positions = index_positions(mesh, stack.frame, Vec3d(origin), plan.voxel);
    // The sign uses all triangles, distances only those that clustering keeps.
    const Surface whole{positions, triangles};
    const WindingColumns columns(positions, triangles);
    std::optional<ClusteredSurface> clustered;
    if (plan.cluster) {
        clustered.emplace(whole, cluster_cell);
        check_clustered(plan, clustered->surface().triangles.size(), options.grid);
        stack.clustered = clustered->surface().triangles.size() < triangles.size();
    }
    stack.sign = choose_sign(options.sign, mesh, columns, positions, triangles, stack.warnings);
    Surface near = clustered ? clustered->surface() : whole;
    std::vector<Triangle> single;
    if (stack.sign == Sign::sheet) {
        single = without_duplicate_faces(near.positions, near.triangles);
        near.triangles = single;
    }
    const TriangleTree tree = tree_of(near);

    if (plan.voxel > 0.25f * options.grid.radius)
        stack.warnings.push_back(fmt::format(
            "the voxel is {} times the radius, which is too coarse to resolve occlusion: use a voxel of {} % of "
            "the diagonal or less",
            rounded(plan.voxel / options.grid.radius, 2), rounded(12.5 * options.grid.radius, 2)));
    // The shares of the time are rough.
    const auto done = [&](double share) {
        if (options.progress)
            options.progress(share);
    };
    std::optional<Pseudonormals> normals;
    if (stack.sign == Sign::sheet)
        normals.emplace(near.positions, near.triangles);
    const Band band =
        normals ? Band(tree, *normals, plan.outer_band) : Band(tree, columns, {plan.outer_band, plan.inner_band});
    done(0.3);
    for (int level = 0; level < plan.levels; ++level) {
        const float voxel = std::ldexp(plan.voxel, level);
        LevelSet set = level_set(band, 1 << level, double(voxel) * stack.frame.diagonal / stack.value_unit,
                                 level > 0 ? &stack.levels.back() : nullptr);
        set.origin = origin;
        set.voxel = voxel;
        set.outer_band = plan.outer_band;
        set.inner_band = normals ? plan.outer_band : plan.inner_band;
        stack.levels.push_back(std::move(set));
        done(1.0 - 0.2 * std::ldexp(1.0, -2 * level));
    }
    done(1.0);
    return stack;
}

Sign sign_of(const Mesh& mesh, std::span<const Triangle> triangles) {
    const LevelPlan plan = plan_levels(mesh, triangles, {});
    const Box box = mesh.box();
    const Frame frame = frame_of(box);
    const HugeVector<Vec3d> positions = index_positions(mesh, frame, Vec3d(origin_of(box, frame, plan)), plan.voxel);
    std::vector<std::string> warnings;
    return choose_sign(SignChoice::automatic, mesh, WindingColumns(positions, triangles), positions, triangles,
                       warnings);
}

}
