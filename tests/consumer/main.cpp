// Bakes a valley, a floor and a wall that meet at a right angle, and compares with its closed form: a probe
// at height h over the floor, s from the wall, is min(h, s) away from the surface.
#include <alcove/alcove.h>

#include <cmath>
#include <cstdio>

namespace {

constexpr int cells = 40;
constexpr double width = 2.0;

alcove::Mesh make_valley() {
    alcove::Mesh mesh;
    for (int along = 0; along <= cells; ++along)
        for (int across = -cells; across <= cells; ++across) {
            const double x = std::max(across, 0) * width / cells, y = std::max(-across, 0) * width / cells;
            mesh.positions.emplace_back(x, y, along * width / cells);
        }
    constexpr std::uint32_t row = 2 * cells + 1;
    for (std::uint32_t along = 0; along < cells; ++along)
        for (std::uint32_t across = 0; across + 1 < row; ++across) {
            const std::uint32_t a = along * row + across, b = a + row;
            mesh.add_face(std::array{a, b, b + 1, a + 1});
        }
    return mesh;
}

double closed_form(double to_wall, const alcove::Classic& classic) {
    const double scale = classic.radius / alcove::Classic::reference_radius;
    double ao = 1.0;
    for (int i = 0; i < 5; ++i) {
        const double height = 0.01 + 0.12 * i / 4;
        ao -= 3.0 * std::pow(0.95, i) * std::max(0.0, height - to_wall / scale);
    }
    return ao;
}

}

int main() {
    alcove::Mesh mesh = make_valley();
    const auto triangles = alcove::triangulate(mesh).triangles;
    const alcove::Frame frame = alcove::frame_of(mesh.box());
    const alcove::Classic classic{.radius = 0.1f};
    const alcove::LevelStack field(alcove::voxelize(mesh, triangles, {.grid = {.radius = classic.radius}}));
    const auto surfels = alcove::make_surfels(mesh, triangles, frame);
    mesh.set_attribute({"ao", 1, alcove::bake(surfels, field, classic)});

    double largest_difference = 0.0;
    int compared = 0;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
        const alcove::Vec3d p = mesh.positions[v];
        if (p.x <= 0.0 || p.x > width / 2 || std::abs(p.z - width / 2) > width / 4)
            continue; // not on the floor, or in reach of the rim
        const double ao = mesh.find_attribute("ao")->values[v];
        const double expected = closed_form(p.x / frame.diagonal, classic);
        largest_difference = std::max(largest_difference, std::abs(ao - expected));
        ++compared;
        if (std::abs(p.z - width / 2) < 1e-9)
            std::printf("%.3f from the wall: ao %.3f, closed form %.3f\n", p.x, ao, expected);
    }
    std::printf("%d vertices, largest difference %.4f\n", compared, largest_difference);
    // Where floor and wall are equally far, interpolating between voxels rounds the crease off.
    return compared == 0 || largest_difference > 0.03;
}
