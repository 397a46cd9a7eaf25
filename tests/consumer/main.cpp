// Calls bake() from an installed package: a valley, a floor and a wall that meet at a right angle, against its closed
// form.
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

/// The ao of a floor at distance x from a wall, both larger than the radius.
double closed_form(double x, double radius) {
    const double u = std::min(1.0, x / radius);
    return 1.0 - (std::acos(u) - u * std::sqrt(1.0 - u * u)) / std::acos(-1.0);
}

}

int main() {
    auto mesh = make_valley();
    const auto baked = alcove::bake(mesh, {.radius = "0.5", .quality = alcove::Quality::fine});
    alcove::add(mesh, baked);
    alcove::write_mesh(mesh, "valley.ply");

    double squares = 0.0;
    int compared = 0;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
        const alcove::Vec3d p = mesh.positions[v];
        if (p.x <= 0.0 || p.x > width / 2 || std::abs(p.z - width / 2) > width / 4)
            continue; // not on the floor, or within reach of the rim
        squares += std::pow(baked.ao()[v] - closed_form(p.x, baked.radius), 2);
        ++compared;
    }
    const double rmse = std::sqrt(squares / compared);
    std::printf("%d vertices by %s, RMSE %.4f\n", compared, baked.method.c_str(), rmse);
    return compared == 0 || rmse > 0.015;
}
