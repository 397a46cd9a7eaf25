#include "alcove/grid/voxelize.h"

#include "alcove/base/detail/duplicate_faces.h"
#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/parallel.h"
#include "alcove/base/types.h"
#include "alcove/grid/detail/clustered.h"
#include "alcove/grid/detail/level_set.h"
#include "alcove/grid/detail/partial_levels.h"
#include "alcove/grid/detail/plan.h"
#include "alcove/grid/detail/sign.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace alcove {
namespace {

/// Where the voxels are.
struct Placing {
    double voxel; ///< edge of the finest voxel, unit space
    Vec3d origin; ///< of index (0, 0, 0) on all levels, unit space
    Index3 first; ///< index on the finest level where the work begins: all bands have larger indices
};

/// Without a lattice, all bands have positive indices, so that an OpenVDB tree has one node below its root rather than
/// eight, each a quarter of a megabyte.
Placing place(const Box& box, const Frame& frame, const LevelPlan& plan, const std::optional<Lattice>& lattice) {
    const float coarsest = std::ldexp(1.0f, plan.levels - 1), margin = coarsest * (std::ceil(plan.outer_band) + 2.0f);
    if (!lattice)
        return {plan.voxel, Vec3d(frame.to_unit(box.min) - plan.voxel * margin), Index3(0)};
    Placing placing{lattice->voxel / frame.diagonal, exact_in_unit(frame, lattice->origin), Index3(0)};
    const double step = brick_size * double(coarsest); // so that bricks of all levels begin at `first`
    constexpr double farthest = 1 << 30;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = (box.min[axis] - lattice->origin[axis]) / lattice->voxel;
        if (!(std::fabs(low) + std::fabs(box.max[axis] - box.min[axis]) / lattice->voxel < farthest))
            throw InputError("the mesh is more than 2^30 voxels from the origin of the lattice: move it nearer, or use "
                             "larger voxels");
        placing.first[axis] = static_cast<int>(std::floor((low - margin) / step) * step);
    }
    return placing;
}

/// A position in voxels of the finest level.
Vec3d index_position(const Vec3d& scene, const Frame& frame, const Placing& placing) {
    return (exact_in_unit(frame, scene) - placing.origin) / placing.voxel - Vec3d(placing.first);
}

/// The positions of the vertices; 0 for those outside the box of the vertices that faces use.
HugeVector<Vec3d> index_positions(const Mesh& mesh, const Box& box, const Frame& frame, const Placing& placing) {
    HugeVector<Vec3d> positions(mesh.positions.size());
    parallel_for(positions.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const Vec3d& p = mesh.positions[v];
            const bool in_box = glm::clamp(p, box.min, box.max) == p;
            positions[v] = in_box ? index_position(p, frame, placing) : Vec3d(0.0);
        }
    });
    return positions;
}

/// `most` is the position of the upper corner of their box.
WindingColumns columns_of(std::span<const Vec3d> positions, std::span<const Triangle> triangles, const Vec3d& most) {
    return {positions, triangles, std::max({most.x, most.y, 1.0})};
}

GridOptions with_voxel_of_lattice(GridOptions options, const Frame& frame) {
    if (options.lattice)
        options.voxel = static_cast<float>(options.lattice->voxel / frame.diagonal);
    return options;
}

/// Partial levels pay off where few voxels are unresolved. Otherwise, a finer voxel is better.
constexpr double most_unresolved = 0.2;

/// The limit for the bricks of all partial levels: as many as the spare memory holds, but at most 1.5 times those of
/// the finest level, so that time and memory are at most about three times as large.
std::size_t bricks_for_partial_levels(std::size_t finest, const LevelPlan& plan) {
    return static_cast<std::size_t>(
        std::min(plan.spare_bytes / bytes_per_partial_brick, 1.5 * static_cast<double>(finest)));
}

TriangleTree tree_of(const Surface& surface) {
    const FragmentLeaves fragments(surface.positions, surface.triangles);
    if (fragments.count() == 0)
        throw InputError("the mesh has no face with nonzero area: there is no surface to occlude anything");
    return TriangleTree(fragments);
}

}

GridStack voxelize(const Mesh& mesh, std::span<const Triangle> triangles, const VoxelizeOptions& options) {
    GridStack stack;
    const Box box = mesh.box();
    stack.frame = frame_of(box);
    stack.value_unit = value_unit_of(stack.frame);
    stack.lattice = options.grid.lattice;
    const LevelPlan plan = plan_levels(surface_size(mesh, triangles, stack.frame), triangles.size(),
                                       with_voxel_of_lattice(options.grid, stack.frame));
    const Placing placing = place(box, stack.frame, plan, stack.lattice);
    const HugeVector<Vec3d> positions = index_positions(mesh, box, stack.frame, placing);
    // The sign is computed from all triangles, distances only from those that clustering keeps.
    const Surface whole{positions, triangles};
    const WindingColumns columns = columns_of(positions, triangles, index_position(box.max, stack.frame, placing));
    const bool is_balanced = balanced(triangles);
    std::optional<ClusteredSurface> clustered;
    if (plan.cluster) {
        clustered.emplace(whole, is_balanced, cluster_cell);
        check_clustered(plan, clustered->surface().triangles.size(), options.grid);
        stack.clustered = clustered->surface().triangles.size() < triangles.size();
    }
    std::vector<std::string> about_faces;
    stack.sign = choose_sign(options.sign, mesh, columns, is_balanced, positions, triangles, about_faces);
    if (options.warns_of_faces)
        stack.warnings.insert(stack.warnings.end(), about_faces.begin(), about_faces.end());
    Surface near = clustered ? clustered->surface() : whole;
    std::vector<Triangle> single;
    if (stack.sign == Sign::sheet) {
        single = without_duplicate_faces<Vec3d>(near.positions, near.triangles);
        near.triangles = single;
    }
    const TriangleTree tree = tree_of(near);

    if (plan.voxel > 0.25f * options.grid.radius)
        stack.warnings.push_back(fmt::format(
            "the voxel is {} times the radius, which is too coarse to resolve occlusion: use --voxel {}% or less",
            rounded(plan.voxel / options.grid.radius, 2), rounded(12.5 * options.grid.radius, 2)));
    // The shares of the time are approximate.
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
    const bool refines = options.grid.refine && options.grid.voxel == 0.0f && !stack.lattice;
    std::vector<NearestOfBrick> nearest;
    for (int level = 0; level < plan.levels; ++level) {
        const double voxel = std::ldexp(placing.voxel, level);
        LevelSet set =
            level_set(band, 1 << level, voxel * stack.frame.diagonal / stack.value_unit, placing.first,
                      level > 0 ? &stack.levels.back() : nullptr, level == 0 && refines ? &nearest : nullptr);
        set.origin = placing.origin;
        set.voxel = voxel;
        set.outer_band = plan.outer_band;
        set.inner_band = normals ? plan.outer_band : plan.inner_band;
        stack.levels.push_back(std::move(set));
        done(1.0 - 0.2 * std::ldexp(1.0, -2 * level));
    }
    if (refines) {
        const double value_scale = placing.voxel * stack.frame.diagonal / stack.value_unit;
        const UnresolvedVoxels unresolved = find_unresolved(nearest, near);
        if (unresolved.share <= most_unresolved)
            stack.partial = partial_levels(unresolved, {.surface = whole,
                                                        .sign = stack.sign,
                                                        .width = band.width(),
                                                        .voxel = placing.voxel,
                                                        .origin = placing.origin,
                                                        .value_scale = value_scale,
                                                        .max_bricks = bricks_for_partial_levels(nearest.size(), plan),
                                                        .max_bytes = plan.spare_bytes});
    }
    done(1.0);
    return stack;
}

Sign sign_of(const Mesh& mesh, std::span<const Triangle> triangles) {
    const Box box = mesh.box();
    const Frame frame = frame_of(box);
    const LevelPlan plan = plan_levels(surface_size(mesh, triangles, frame), triangles.size(), {});
    const Placing placing = place(box, frame, plan, {});
    const HugeVector<Vec3d> positions = index_positions(mesh, box, frame, placing);
    const WindingColumns columns = columns_of(positions, triangles, index_position(box.max, frame, placing));
    std::vector<std::string> warnings;
    return choose_sign(SignChoice::automatic, mesh, columns, balanced(triangles), positions, triangles, warnings);
}

}
