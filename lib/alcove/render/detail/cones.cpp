#include "alcove/render/detail/cones.h"

#include <array>
#include <cmath>

namespace alcove {
namespace {

constexpr std::size_t capacity = 256;

/// Marches at most `capacity` cones.
void march(const AnyField& field, const Vec3d& eye, std::span<Cone> cones, double far, float margin) {
    std::array<float, capacity> x, y, z, distance;
    std::array<std::uint16_t, capacity> active;
    std::size_t count = cones.size();
    const bool both_sides = two_sided(field);
    for (std::size_t i = 0; i < count; ++i)
        active[i] = static_cast<std::uint16_t>(i);
    constexpr int max_steps = 48;
    for (int step = 0; step < max_steps && count > 0; ++step) {
        for (std::size_t k = 0; k < count; ++k) {
            const Cone& cone = cones[active[k]];
            const Vec3 p(eye + cone.travelled * cone.axis);
            x[k] = p.x, y[k] = p.y, z[k] = p.z;
        }
        map_batch(field, Points{x.data(), y.data(), z.data(), count}, any_reach, distance.data());
        std::size_t left = 0;
        for (std::size_t k = 0; k < count; ++k) {
            Cone& cone = cones[active[k]];
            const double width = cone.slope * cone.travelled;
            const double safe = double(both_sides ? std::fabs(distance[k]) : distance[k]) - double(margin) - width;
            cone.travelled += std::max(safe, 0.0);
            // When a step gains little, tracing the rays individually is faster.
            constexpr double worthwhile = 0.5;
            active[left] = active[k];
            left += safe > worthwhile * width && cone.travelled < far;
        }
        count = left;
    }
}

}

void march_cones(const AnyField& field, const Vec3d& eye, std::span<Cone> cones, double far, float margin) {
    for (std::size_t begin = 0; begin < cones.size(); begin += capacity)
        march(field, eye, cones.subspan(begin, std::min(capacity, cones.size() - begin)), far, margin);
}

}
