// Converts a mesh to a stack of level sets and saves it:
//
//     make_grid INPUT OUTPUT.vdb
#include <alcove/grid/voxelize.h>
#include <alcove/mesh/files.h>
#include <alcove/mesh/triangulate.h>
#include <alcove/vdb/vdb_file.h>

#include <cstdio>
#include <exception>

int main(int argument_count, char** arguments) try {
    if (argument_count != 3) {
        std::fprintf(stderr, "usage: make_grid INPUT OUTPUT.vdb\n");
        return 2;
    }
    const alcove::Mesh mesh = alcove::read_mesh(arguments[1]);
    const auto triangles = alcove::triangulate(mesh).triangles;

    // Lengths are in unit space, where the diagonal of the mesh is 1.
    alcove::VoxelizeOptions options;
    options.grid.radius = 0.2f;         // store distances up to a fifth of the diagonal
    options.grid.voxel = 1.0f / 200.0f; // edge of the finest voxel
    const alcove::GridStack stack = alcove::voxelize(mesh, triangles, options);
    alcove::write_grids(stack, arguments[2]);

    std::printf("a %s of %zu levels\n", stack.sign == alcove::Sign::solid ? "solid" : "sheet", stack.levels.size());
    for (const alcove::LevelSet& level : stack.levels)
        std::printf("voxel %.4f, %zu active voxels\n", level.voxel * stack.frame.diagonal, level.active_voxels);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "make_grid: %s\n", error.what());
    return 1;
}
