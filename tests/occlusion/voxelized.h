/// A voxelized mesh with its surfels, for occlusion tests.
#pragma once

#include "alcove/field/level_stack.h"
#include "alcove/grid/voxelize.h"
#include "alcove/mesh/normals.h"
#include "alcove/mesh/triangulate.h"

#include <utility>

namespace alcove::test {

struct Voxelized {
    /// The inner band is as wide as the outer one, because some channels read the inside.
    explicit Voxelized(Mesh made, float radius, float voxel = 0.0f, SignChoice sign = SignChoice::automatic)
        : mesh(std::move(made)), triangles(triangulate(mesh).triangles), frame(frame_of(mesh.box())),
          surfels(make_surfels(mesh, triangles, frame)),
          field(voxelize(mesh, triangles, options(radius, voxel, sign))) {}

    Mesh mesh;
    std::vector<Triangle> triangles;
    Frame frame;
    std::vector<Surfel> surfels; ///< one per vertex
    LevelStack field;

  private:
    static VoxelizeOptions options(float radius, float voxel, SignChoice sign) {
        VoxelizeOptions options;
        options.sign = sign;
        options.grid.radius = radius;
        options.grid.voxel = voxel;
        options.grid.inner_band = options.grid.outer_band;
        return options;
    }
};

}
