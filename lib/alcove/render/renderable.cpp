#include "alcove/render/renderer.h"

#include "alcove/base/types.h"
#include "alcove/field/primitives.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace alcove {

float Ground::coverage(const Vec3& p) const {
    return std::clamp((gone - glm::length(p)) / (gone - whole), 0.0f, 1.0f);
}

AnyField Renderable::surroundings() const {
    if (grounds.empty())
        return field;
    std::vector<AnyField> all{field};
    for (const Ground& ground : grounds)
        all.emplace_back(ground.plane);
    return UnionOf<AnyField>(std::move(all));
}

const Ground* ground_of(const Renderable& renderable, ObjectId object) {
    const std::size_t parts = std::max<std::size_t>(1, renderable.parts.size());
    return object > parts ? &renderable.grounds[object - parts - 1] : nullptr;
}

const Material& material_of(const Renderable& renderable, ObjectId object) {
    static const Material plain;
    if (const Ground* ground = ground_of(renderable, object))
        return ground->material;
    return renderable.parts.empty() ? plain : renderable.parts[object - 1u].material;
}

bool has_edge_colors(const Renderable& renderable) {
    const auto has = [](const auto& object) { return object.material.edge_color.has_value(); };
    return std::any_of(renderable.parts.begin(), renderable.parts.end(), has) ||
           std::any_of(renderable.grounds.begin(), renderable.grounds.end(), has);
}

Outline outline(const AnyField& field, const Frame& frame) {
    constexpr int cells = 64;
    constexpr float cell = 1.0f / cells, half_diagonal = 0.8660254f * cell;
    const auto center = [](int i) { return (static_cast<float>(i) + 0.5f) * cell - 0.5f; };
    Outline result;
    std::array<float, cells> x, y, z, distance;
    for (int i = 0; i < cells; ++i)
        z[static_cast<std::size_t>(i)] = center(i);
    for (int i = 0; i < cells; ++i)
        for (int k = 0; k < cells; ++k) {
            x.fill(center(i));
            y.fill(center(k));
            map_batch(field, Points{x.data(), y.data(), z.data(), cells}, any_reach, distance.data());
            for (std::size_t l = 0; l < cells; ++l)
                if (std::fabs(distance[l]) <= half_diagonal) {
                    const Vec3 p(x[l], y[l], z[l]);
                    result.points.push_back(frame.to_scene(p));
                    result.box.add(frame.to_scene(p - 0.5f * cell));
                    result.box.add(frame.to_scene(p + 0.5f * cell));
                }
        }
    if (result.points.empty())
        throw InputError("the grid contains no surface: its distances are nowhere near 0");
    return result;
}

}
