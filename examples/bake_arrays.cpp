// Bakes ambient occlusion for a mesh in arrays of the caller, without files: a floor and a wall.
#include <alcove/bake/bake.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <vector>

int main() try {
    const std::vector<float> positions{0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 1};
    const std::vector<std::uint32_t> quads{0, 3, 2, 1, 0, 4, 5, 3};

    alcove::Mesh mesh;
    for (std::size_t i = 0; i < positions.size(); i += 3)
        mesh.positions.emplace_back(positions[i], positions[i + 1], positions[i + 2]);
    for (std::size_t i = 0; i < quads.size(); i += 4)
        mesh.add_face(std::array{quads[i], quads[i + 1], quads[i + 2], quads[i + 3]});

    const std::vector<float> ao = alcove::bake(mesh).ao(); // one value per vertex, in the order of the arrays
    std::printf("%.2f in the corner, %.2f at the free edge of the floor\n", ao[0], ao[1]);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "bake_arrays: %s\n", error.what());
    return 1;
}
