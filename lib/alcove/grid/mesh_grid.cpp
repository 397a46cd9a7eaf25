#include "alcove/grid/mesh_grid.h"

#include "alcove/errors.h"
#include "alcove/grid/vdb.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/diagnose.h"
#include "alcove/mesh/triangulate.h"

#include <openvdb/tools/VolumeToMesh.h>

namespace alcove {

Mesh mesh_zero_surface(const GridStack& stack, float adaptivity) {
    if (stack.sign == Sign::sheet)
        throw InputError(
            "the grid holds an open surface as a sheet, which has no back to be meshed: bake the "
            "mesh it was made from");
    const LevelSet& finest = stack.levels.front();
    const auto in_index_space =
        finest.grid->grid->copyReplacingTransform(openvdb::math::Transform::createLinearTransform(1.0));
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(*in_index_space, points, triangles, quads, 0.0, adaptivity);
    if (points.empty())
        throw InputError("the grid holds no surface: its distances nowhere change their sign");

    Mesh mesh;
    mesh.positions.reserve(points.size());
    for (const openvdb::Vec3s& p : points) {
        const Vec3d unit = Vec3d(finest.origin) + double(finest.voxel) * Vec3d(p.x(), p.y(), p.z());
        mesh.positions.push_back(unit * stack.frame.diagonal + stack.frame.center);
    }
    // OpenVDB's faces turn inward.
    for (const openvdb::Vec4I& q : quads)
        mesh.add_face(std::array{q[3], q[2], q[1], q[0]});
    for (const openvdb::Vec3I& t : triangles)
        mesh.add_face(std::array{t[2], t[1], t[0]});
    return mesh;
}

GridStack extend_levels(GridStack stack, float radius, bool inside) {
    const bool replace = inside && !stack.knows_inside();
    if (!replace && stack.reach() >= std::min(radius, 1.0f))
        return stack;
    const Mesh surface = mesh_zero_surface(stack);
    const double scale = stack.frame.diagonal / frame_of(surface.box()).diagonal;
    VoxelizeOptions options;
    options.grid.radius = static_cast<float>(radius * scale);
    const double voxel = replace ? stack.levels.front().voxel : 2.0 * stack.levels.back().voxel;
    options.grid.voxel = static_cast<float>(voxel * scale);
    if (inside)
        options.grid.inner_band = options.grid.outer_band;
    options.sign = closedness(surface).closed() ? SignChoice::solid : SignChoice::sheet;
    GridStack coarser = voxelize(surface, triangulate(surface).triangles, options);
    if (replace)
        stack.levels.clear();
    const double value_scale = coarser.value_unit / stack.value_unit;
    coarser = reframed(std::move(coarser), stack.frame);
    for (LevelSet& level : coarser.levels) {
        const auto grid = level.grid->grid->deepCopy();
        scale_values(*grid, value_scale);
        level.grid = std::make_shared<VdbGrid>(VdbGrid{grid});
        stack.levels.push_back(std::move(level));
    }
    if (coarser.sign == Sign::sheet)
        stack.sign = Sign::sheet;
    return stack;
}

}
