/// Flat, long and sharp shapes: boxes, needles and slivers. Their ao is known in closed form or from exact rays.
#include "shapes.h"
#include "extreme.h"

#include <fmt/format.h>

#include <numbers>

namespace alcove::extremes {
namespace {

/// A cylinder of height 1 whose sides are needles, as long as it is high; more `sides` make them thinner.
Mesh needle_cylinder(std::uint32_t sides) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < sides; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / sides;
        for (const double z : {-0.5, 0.5})
            mesh.positions.emplace_back(0.5 * std::cos(angle), 0.5 * std::sin(angle), z);
    }
    std::vector<std::uint32_t> top, bottom;
    for (std::uint32_t i = 0; i < sides; ++i) {
        const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % sides);
        mesh.add_face(std::array{a, b, b + 1});
        mesh.add_face(std::array{a, b + 1, a + 1});
        top.push_back(a + 1);
        bottom.insert(bottom.begin(), a);
    }
    mesh.add_face(top);
    mesh.add_face(bottom);
    return mesh;
}

/// Cuts each triangle into three, at a point whose distance from one side is `share` of the height.
Mesh with_slivers(const Mesh& mesh, double share) {
    Mesh cut;
    cut.positions = mesh.positions;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const auto face = mesh.face(f);
        const Vec3d a = mesh.positions[face[0]], b = mesh.positions[face[1]], c = mesh.positions[face[2]];
        const auto middle = static_cast<std::uint32_t>(cut.positions.size());
        cut.positions.push_back(0.5 * (1.0 - share) * (a + b) + share * c);
        for (std::size_t k = 0; k < 3; ++k)
            cut.add_face(std::array{face[k], face[(k + 1) % 3], middle});
    }
    return cut;
}

}

std::vector<Extreme> shapes() {
    std::vector<Extreme> rows;
    const auto add = [&](std::string name, std::string must, std::function<Result()> run) {
        rows.push_back({"shape", std::move(name), std::move(must), std::move(run)});
    };
    for (const auto& [name, half] :
         {std::pair("plate 1 : 1 : 1e-2", Vec3d(1, 1, 1e-2)), std::pair("plate 1 : 1 : 1e-5", Vec3d(1, 1, 1e-5)),
          std::pair("rod 1 : 1e-2 : 1e-2", Vec3d(1, 1e-2, 1e-2)),
          std::pair("rod 1 : 1e-5 : 1e-5", Vec3d(1, 1e-5, 1e-5)), std::pair("1 : 1e-2 : 1e-5", Vec3d(1, 1e-2, 1e-5))})
        add(name,
            "1 everywhere, because nothing occludes a convex shape; tolerance 0.02 for the rounding of the "
            "grid",
            [half = half] {
                return against_value(Baked(test::box_mesh(half, 8)), 1.0f, {"traced", "guided", "exact"}, 0.02);
            });
    add("needles 1 : 3e3", "1 everywhere", [] {
        return against_value(Baked(needle_cylinder(10000)), 1.0f, {"traced", "guided", "exact"}, 0.02);
    });
    for (const double share : {1e-3, 1e-6, 1e-9})
        add(fmt::format("slivers, {:g} of their length high", share),
            "RMSE at most 0.01 relative to the surface without slivers: they change the weights of faces in the "
            "normals",
            [=] {
                return rmse_against(bumpy(), with_slivers(bumpy(), share), {"traced", "exact"}, 0.01);
            });
    add("a single triangle", "1 on both sides", [] {
        Mesh mesh;
        mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        mesh.add_face(std::array{0u, 1u, 2u});
        return against_value(Baked(mesh), 1.0f, all_kinds, 0.02);
    });
    add("a single triangle 1e-9 of its length high", "1 on both sides", [] {
        Mesh mesh;
        mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0.3, 1e-9, 0}};
        mesh.add_face(std::array{0u, 1u, 2u});
        return against_value(Baked(mesh), 1.0f, {"traced", "guided", "exact"}, 0.02);
    });
    return rows;
}

}
