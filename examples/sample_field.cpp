// Evaluates signed distances: at one point, at a batch of points, and of a mesh together with a ground plane:
//
//     sample_field INPUT
#include <alcove/field/level_stack.h>
#include <alcove/field/primitives.h>
#include <alcove/grid/voxelize.h>
#include <alcove/mesh/files.h>
#include <alcove/mesh/triangulate.h>

#include <array>
#include <cstdio>
#include <exception>

int main(int argument_count, char** arguments) try {
    if (argument_count != 2) {
        std::fprintf(stderr, "usage: sample_field INPUT\n");
        return 2;
    }
    const alcove::Mesh mesh = alcove::read_mesh(arguments[1]);
    const auto triangles = alcove::triangulate(mesh).triangles;
    const alcove::GridStack stack = alcove::voxelize(mesh, triangles, {.grid = {.radius = 0.3f}});
    const alcove::LevelStack field(stack);

    // Points and distances are in unit space. The frame converts from and to scene units.
    const alcove::Frame& frame = stack.frame;
    const alcove::Vec3 lowest = frame.to_unit(mesh.box().min), highest = frame.to_unit(mesh.box().max);
    const alcove::Vec3 above{0.0f, highest.y + 0.1f, 0.0f};
    std::printf("above the box: %.3f scene units\n", field.map(above) * frame.diagonal);

    // A batch is three arrays. The caller gives an upper bound on the distance of the points from the surface.
    constexpr std::size_t count = 4;
    std::array<float, count> x{}, y{}, z{}, distances{};
    for (std::size_t i = 0; i < count; ++i)
        x[i] = highest.x + 0.05f * static_cast<float>(i + 1);
    const float reach = 0.3f;
    field.map(alcove::Points{x.data(), y.data(), z.data(), count}, reach, distances.data());
    for (std::size_t i = 0; i < count; ++i)
        std::printf("beside the box, %.2f from it: %.3f\n", x[i] - highest.x, distances[i]);

    // The union of two fields is a field.
    const alcove::Union on_ground(field, alcove::Plane{.offset = lowest.y});
    const alcove::Vec3 near_ground{highest.x + 0.2f, lowest.y + 0.05f, 0.0f};
    std::printf("near the ground: %.3f, without it %.3f\n", on_ground.map(near_ground), field.map(near_ground));
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "sample_field: %s\n", error.what());
    return 1;
}
