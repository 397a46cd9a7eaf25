// Bakes ambient occlusion into a texture map: a floor and a wall that share a square texture.
//
//     bake_map OUTPUT.png
#include <alcove/maps/maps.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <exception>

int main(int argument_count, char** arguments) try {
    if (argument_count != 2) {
        std::fprintf(stderr, "usage: bake_map OUTPUT.png\n");
        return 2;
    }
    alcove::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, {0, 1, 0}, {0, 1, 1}};
    mesh.add_face(std::array<std::uint32_t, 4>{0, 3, 2, 1});
    mesh.add_face(std::array<std::uint32_t, 4>{0, 4, 5, 3});
    mesh.corner_uvs = {{0, 0}, {0, 1}, {0.5, 1}, {0.5, 0}, {0.5, 0}, {1, 0}, {1, 1}, {0.5, 1}}; // one per corner

    alcove::MapOptions options;
    options.width = options.height = 256;
    const alcove::BakedMaps maps = alcove::bake_maps(mesh, {.radius = "30%"}, options);
    alcove::write_maps(maps, arguments[1]);
    std::printf("%zu texels by %s\n", maps.texels, maps.baked.method.c_str());
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "bake_map: %s\n", error.what());
    return 1;
}
