// Bakes ambient occlusion at the vertices of a mesh and writes the mesh with the result:
//
//     bake_mesh INPUT OUTPUT
#include <alcove/bake/bake.h>
#include <alcove/mesh/files.h>

#include <algorithm>
#include <cstdio>
#include <exception>

int main(int argument_count, char** arguments) try {
    if (argument_count != 3) {
        std::fprintf(stderr, "usage: bake_mesh INPUT OUTPUT\n");
        return 2;
    }
    alcove::Mesh mesh = alcove::read_mesh(arguments[1]);
    const alcove::Baked baked = alcove::bake(mesh, {.radius = "10%", .quality = alcove::Quality::good});
    alcove::add(mesh, baked);
    alcove::write_mesh(mesh, arguments[2]);

    const auto [lowest, highest] = std::minmax_element(baked.ao().begin(), baked.ao().end());
    std::printf("%zu vertices, ao from %.2f to %.2f, by %s\n", baked.ao().size(), *lowest, *highest,
                baked.method.c_str());
    for (const std::string& warning : baked.warnings)
        std::fprintf(stderr, "bake_mesh: warning: %s\n", warning.c_str());
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "bake_mesh: %s\n", error.what());
    return 1;
}
