#include "alcove/grid/voxelize.h"

#include "alcove/base/types.h"
#include "alcove/grid/detail/vdb_grid.h"
#include "alcove/mesh/diagnose.h"
#include "alcove/mesh/triangulate.h"

#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cmath>

namespace alcove {

namespace {

/// Meshes the zero isosurface of a grid. `place` maps index coordinates to positions; if it mirrors, faces are turned.
template <class Place>
Mesh mesh_of(const openvdb::FloatGrid& grid, float adaptivity, const Place& place, bool mirrors = false) {
    // OpenVDB returns positions as floats, which are inaccurate far from the origin.
    openvdb::CoordBBox leaves;
    const openvdb::Coord low = grid.tree().evalLeafBoundingBox(leaves)
                                   ? leaves.min() & ~(int(openvdb::FloatTree::RootNodeType::ChildNodeType::DIM) - 1)
                                   : openvdb::Coord(0);
    const auto shift = openvdb::math::Transform::createLinearTransform(1.0);
    shift->postTranslate(-low.asVec3d());
    const auto in_index_space = grid.copyReplacingTransform(shift);
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(*in_index_space, points, triangles, quads, 0.0, adaptivity);
    if (points.empty())
        throw InputError("the grid contains no surface: its distances never change sign");
    Mesh mesh;
    mesh.positions.reserve(points.size());
    for (const openvdb::Vec3s& p : points)
        mesh.positions.push_back(place(Vec3d(p.x(), p.y(), p.z()) + Vec3d(low.x(), low.y(), low.z())));
    // OpenVDB's faces point inward.
    for (const openvdb::Vec4I& q : quads)
        mesh.add_face(mirrors ? std::array{q[0], q[1], q[2], q[3]} : std::array{q[3], q[2], q[1], q[0]});
    for (const openvdb::Vec3I& t : triangles)
        mesh.add_face(mirrors ? std::array{t[0], t[1], t[2]} : std::array{t[2], t[1], t[0]});
    return mesh;
}

}

Mesh mesh_zero_surface(const GridStack& stack, float adaptivity) {
    if (stack.sign == Sign::sheet)
        throw InputError("the grid stores an open surface as a sheet, which has no back side to mesh: bake the "
                         "mesh that it was voxelized from");
    const LevelSet& finest = stack.levels.front();
    return mesh_of(*finest.grid->grid, adaptivity, [&](const Vec3d& index) {
        const Vec3d unit = finest.origin + finest.voxel * index;
        return unit * stack.frame.diagonal + stack.frame.center;
    });
}

Mesh mesh_zero_surface(const VdbGrid& grid) {
    const auto map = grid.grid->transform().baseMap();
    return mesh_of(
        *grid.grid, 0.0f,
        [&](const Vec3d& index) {
            const openvdb::Vec3d at = map->applyMap({index.x, index.y, index.z});
            return Vec3d(at.x(), at.y(), at.z());
        },
        map->determinant() < 0.0);
}

Mesh mesh_zero_surface(const Sampler& sample, float voxel) {
    openvdb::initialize();
    constexpr int side = openvdb::FloatTree::LeafNodeType::DIM;
    const int blocks = static_cast<int>(std::ceil(0.5f / (voxel * side))) + 1; // in each direction
    // The surface needs no distances beyond this band.
    const float band = 3.0f * voxel, half_diagonal = 0.87f * side * voxel;
    const auto grid = openvdb::FloatGrid::create(band);
    grid->setGridClass(openvdb::GRID_LEVEL_SET); // determines the orientation of the faces
    std::vector<Vec3> points(openvdb::FloatTree::LeafNodeType::SIZE);
    std::vector<float> distances(points.size());
    for (int x = -blocks; x < blocks; ++x)
        for (int y = -blocks; y < blocks; ++y) {
            std::vector<Vec3> centers;
            for (int z = -blocks; z < blocks; ++z)
                centers.push_back(voxel * side * (Vec3(x, y, z) + 0.5f));
            std::vector<float> away(centers.size());
            sample(centers, away.data());
            for (int z = -blocks; z < blocks; ++z) {
                const float distance = away[static_cast<std::size_t>(z) + static_cast<std::size_t>(blocks)];
                const openvdb::Coord low(side * x, side * y, side * z);
                if (std::fabs(distance) > half_diagonal + band) {
                    if (distance < 0.0f) // deep inside
                        grid->tree().addTile(1, low, -band, false);
                    continue;
                }
                auto* leaf = grid->tree().touchLeaf(low);
                for (openvdb::Index i = 0; i < points.size(); ++i) {
                    const openvdb::Coord at = leaf->offsetToGlobalCoord(i);
                    points[i] = voxel * Vec3(at.x(), at.y(), at.z());
                }
                sample(points, distances.data());
                for (openvdb::Index i = 0; i < points.size(); ++i)
                    leaf->setValueOn(i, std::clamp(distances[i], -band, band));
            }
        }
    return mesh_of(*grid, 0.0f, [&](const Vec3d& index) { return double(voxel) * index; });
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
    if (stack.lattice)
        options.grid.lattice = {replace ? stack.lattice->voxel : stack.scene_voxel(stack.levels.size()),
                                stack.lattice->origin};
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
