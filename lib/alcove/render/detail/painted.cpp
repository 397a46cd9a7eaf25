#include "alcove/render/detail/painted.h"

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

/// The nearest triangle at every sample.
struct Canvas {
    int width, height;
    std::vector<float> depth, value;
    std::vector<Vec3> normal;

    Canvas(int w, int h)
        : width(w), height(h), depth(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), far_depth),
          value(depth.size()), normal(depth.size(), Vec3(0.0f)) {}

    std::size_t place(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

double cross(const Vec3d& a, const Vec3d& b) {
    return a.x * b.y - a.y * b.x;
}

/// Rasterises a triangle. `corners` are canvas coordinates and depth.
void draw(const std::array<Vec3d, 3>& corners, const std::array<float, 3>& values, const Vec3& normal, Canvas& canvas) {
    const Vec3d &a = corners[0], &b = corners[1], &c = corners[2];
    const double area = cross(b - a, c - a);
    if (!(area != 0.0))
        return;
    const auto first = [](double x) { return static_cast<int>(std::clamp(std::ceil(x - 0.5), 0.0, 1e6)); };
    const auto [left, right] = std::minmax({a.x, b.x, c.x});
    const auto [top, bottom] = std::minmax({a.y, b.y, c.y});
    for (int y = first(top); y < std::min(first(bottom) + 1, canvas.height); ++y)
        for (int x = first(left); x < std::min(first(right) + 1, canvas.width); ++x) {
            const Vec3d p(x + 0.5, y + 0.5, 0.0);
            const double u = cross(b - p, c - p) / area, v = cross(c - p, a - p) / area, w = 1.0 - u - v;
            if (u < 0.0 || v < 0.0 || w < 0.0)
                continue;
            // 1/depth is linear across the image.
            const double weights[] = {u / a.z, v / b.z, w / c.z};
            const double depth = 1.0 / (weights[0] + weights[1] + weights[2]);
            const std::size_t at = canvas.place(x, y);
            if (depth >= canvas.depth[at])
                continue;
            canvas.depth[at] = static_cast<float>(depth);
            canvas.value[at] =
                static_cast<float>(depth * (weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2]));
            canvas.normal[at] = normal;
        }
}

Image resolve(const Canvas& canvas, int samples) {
    Image image(canvas.width / samples, canvas.height / samples);
    const float share = 1.0f / static_cast<float>(samples * samples);
    for (int y = 0; y < canvas.height; ++y)
        for (int x = 0; x < canvas.width; ++x) {
            const std::size_t from = canvas.place(x, y);
            const auto to = static_cast<std::size_t>(y / samples) * static_cast<std::size_t>(image.width) +
                            static_cast<std::size_t>(x / samples);
            if (canvas.depth[from] >= far_depth)
                continue;
            image.alpha[to] += share;
            image.ao[to] += share * canvas.value[from];
            if (canvas.depth[from] < image.depth[to]) {
                image.depth[to] = canvas.depth[from];
                image.normal[to] = canvas.normal[from];
            }
        }
    for (std::size_t i = 0; i < image.pixels(); ++i)
        image.color[i] = Vec3(image.ao[i]);
    return image;
}

}

Image paint(std::span<const Vec3d> positions, std::span<const Triangle> triangles, std::span<const float> values,
            const Camera& camera, int samples) {
    Canvas canvas(camera.size().width * samples, camera.size().height * samples);
    for (const Triangle& triangle : triangles) {
        std::array<Vec3d, 3> corners;
        std::array<float, 3> at_corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d p = camera.project(positions[triangle[k]]);
            corners[k] = {p.x * samples, p.y * samples, p.z};
            at_corners[k] = values[triangle[k]];
        }
        if (corners[0].z <= 0.0 || corners[1].z <= 0.0 || corners[2].z <= 0.0)
            continue;
        const Vec3d face = glm::cross(positions[triangle[1]] - positions[triangle[0]],
                                      positions[triangle[2]] - positions[triangle[0]]);
        const double length = glm::length(face);
        if (!(length > 0.0))
            continue;
        const Vec3d to_eye = camera.eye() - positions[triangle[0]];
        const double side = glm::dot(face, to_eye) < 0.0 ? -1.0 : 1.0;
        draw(corners, at_corners, Vec3(side / length * face), canvas);
    }
    return resolve(canvas, samples);
}

}
