// Reads a mesh, computes ambient occlusion at its vertices and writes it with the attribute `ao`:
//
//     bake_mesh stairs.off stairs_ao.ply
#include <alcove/alcove.h>

#include <algorithm>
#include <cstdio>
#include <exception>

int main(int argument_count, char** arguments) try {
    if (argument_count != 3) {
        std::fprintf(stderr, "usage: bake_mesh INPUT OUTPUT\n");
        return 2;
    }
    alcove::Mesh mesh = alcove::read_mesh(arguments[1]);
    const auto triangles = alcove::triangulate(mesh).triangles;

    // Lengths are parts of the diagonal of the mesh: occluders count up to a tenth of it.
    const alcove::Classic classic{.radius = 0.1f};
    const alcove::LevelStack field(alcove::voxelize(mesh, triangles, {.grid = {.radius = classic.radius}}));

    const auto surfels = alcove::make_surfels(mesh, triangles, alcove::frame_of(mesh.box()));
    const std::vector<float> ao = alcove::bake(surfels, field, classic);
    mesh.set_attribute({"ao", 1, ao});
    alcove::write_mesh(mesh, arguments[2]);

    const auto [darkest, brightest] = std::minmax_element(ao.begin(), ao.end());
    std::printf("%zu vertices, ao from %.2f to %.2f\n", ao.size(), *darkest, *brightest);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "bake_mesh: %s\n", error.what());
    return 1;
}
