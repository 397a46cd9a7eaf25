#include "alcove/render/detail/march_steps.h"

#include "alcove/base/parallel.h"
#include "alcove/field/detail/trace.h"

#include <algorithm>

namespace alcove {

std::vector<float> MarchSteps::operator()(const Renderable& renderable, const Camera& camera) const {
    const AnyField surroundings = renderable.surroundings();
    const Vec3d eye = (camera.eye() - renderable.frame.center) / renderable.frame.diagonal;
    const auto width = static_cast<std::size_t>(camera.size().width);
    std::vector<float> ao(width * static_cast<std::size_t>(camera.size().height));
    // Nothing farther than the horizon from the origin is rendered. If the eye is farther away, rays start about there,
    // so that single precision suffices.
    constexpr double horizon = 100.0;
    const double before = std::max(0.0, glm::length(eye) - horizon);
    parallel_for(ao.size(), 16 * RayBatch::capacity, [&](std::size_t begin, std::size_t end) {
        RayBatch rays;
        for (std::size_t first = begin; first < end; first += RayBatch::capacity) {
            const std::size_t last = std::min(end, first + RayBatch::capacity);
            rays.count = 0;
            for (std::size_t i = first; i < last; ++i) {
                const Vec3d direction =
                    camera.direction(static_cast<double>(i % width) + 0.5, static_cast<double>(i / width) + 0.5);
                rays.push_back({Vec3(eye + before * direction), Vec3(direction)}, 0.0f);
            }
            trace(surroundings, rays,
                  {.far = static_cast<float>(2.0 * horizon),
                   .hit_distance = std::max(2e-4f, 0.05f * resolution(surroundings)),
                   .shortest_step = 1e-5f,
                   .max_steps = max_steps,
                   .two_sided = two_sided(surroundings)});
            for (std::size_t k = 0; k < rays.count; ++k)
                ao[first + k] = std::clamp(1.0f - static_cast<float>(rays.steps[k]) / static_cast<float>(max_steps - 1),
                                           0.0f, 1.0f);
        }
    });
    return ao;
}

}
