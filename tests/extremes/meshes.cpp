#include "extreme.h"
#include "shapes.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace alcove::extremes {
namespace {

using Corner = glm::dvec2; // x to the right, z up

/// Sweeps the outline along y, and cuts its sides into quads of at most `size`. The outline is counterclockwise,
/// seen from −y.
Mesh prism(const std::vector<Corner>& outline, double length, int along, double size) {
    std::vector<Corner> points;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Corner a = outline[i], b = outline[(i + 1) % outline.size()];
        const int segments = std::max(1, static_cast<int>(std::ceil(glm::length(b - a) / size)));
        for (int k = 0; k < segments; ++k)
            points.push_back(a + (b - a) * (static_cast<double>(k) / segments));
    }
    const auto count = static_cast<std::uint32_t>(points.size());
    Mesh mesh;
    for (int k = 0; k <= along; ++k)
        for (const Corner& p : points)
            mesh.positions.emplace_back(p.x, (static_cast<double>(k) / along - 0.5) * length, p.y);
    std::vector<std::uint32_t> front, back;
    for (std::uint32_t i = 0; i < count; ++i) {
        for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(along); ++k) {
            const std::uint32_t next = (i + 1) % count, here = k * count, there = here + count;
            mesh.add_face(std::array{here + i, there + i, there + next, here + next});
        }
        front.push_back(i);
        back.insert(back.begin(), static_cast<std::uint32_t>(along) * count + i);
    }
    mesh.add_face(front);
    mesh.add_face(back);
    return mesh;
}

}

Mesh bumpy() {
    Mesh mesh = test::sphere_mesh(5);
    for (Vec3d& p : mesh.positions)
        p *= 1.0 + 0.12 * std::sin(7.0 * p.x + 1.0) * std::cos(6.0 * p.y) + 0.1 * std::sin(9.0 * p.z);
    return mesh;
}

Mesh comb(int fins, double thickness, double gap, bool turned) {
    constexpr double height = 0.1;
    const double width = fins * thickness + (fins - 1) * gap;
    std::vector<Corner> outline{{0.0, -height}, {width, -height}};
    for (int i = fins - 1; i >= 0; --i) {
        const double x = i * (thickness + gap);
        outline.emplace_back(x + thickness, height);
        outline.emplace_back(x, height);
        if (i > 0) {
            outline.emplace_back(x, 0.0);
            outline.emplace_back(x - gap, 0.0);
        }
    }
    for (Corner& p : outline)
        p.x -= 0.5 * width;
    Mesh mesh = prism(outline, 0.6, 12, 0.03);
    if (turned)
        for (Vec3d& p : mesh.positions)
            p = glm::angleAxis(0.7, glm::normalize(Vec3d(1.0, 2.0, 0.5))) * p;
    return mesh;
}

}
