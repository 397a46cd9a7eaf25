#include "alcove/occlusion/methods/exact.h"

#include "alcove/base/parallel.h"
#include "alcove/field/detail/trace.h"

#include <array>

namespace alcove {

void Exact::operator()(const RaySurface& surface, const SurfelBatch& surfels, const Outputs& out) const {
    const CosineLattice lattice(rays);
    float* bent = out[Channel::bent_normal];
    std::array<int, SurfelBatch::capacity> open{};
    std::array<Vec3, SurfelBatch::capacity> mean{};
    RayBatch batch;
    std::array<std::uint8_t, RayBatch::capacity> owner;
    const auto flush = [&] {
        surface.find_occluded(batch, radius);
        for (std::size_t r = 0; r < batch.count; ++r)
            open[owner[r]] += !batch.hit[r];
        for (std::size_t r = 0; bent != nullptr && r < batch.count; ++r)
            if (!batch.hit[r])
                mean[owner[r]] += Vec3(batch.dx[r], batch.dy[r], batch.dz[r]);
        batch.count = 0;
    };
    for (std::size_t i = 0; i < surfels.count; ++i) {
        check_cancelled(); // a surfel may have a million rays
        const Basis basis(surfels.normal(i));
        const Vec3 origin = surfels.ray_origin(i, ray_offset(radius));
        const CosineLattice::Shift shift(hash(surfels.position(i), seed));
        for (int r = 0; r < rays; ++r) {
            owner[batch.count] = static_cast<std::uint8_t>(i);
            batch.push_back({origin, basis.to_world(lattice.direction(r, shift))}, 0.0f);
            if (batch.count == RayBatch::capacity)
                flush();
        }
    }
    flush();
    for (std::size_t i = 0; i < surfels.count; ++i)
        out[Channel::ao][i] = static_cast<float>(open[i]) / static_cast<float>(rays);
    if (bent != nullptr)
        for (std::size_t i = 0; i < surfels.count; ++i) {
            const float length = glm::length(mean[i]);
            const Vec3 direction = length > 0.0f ? mean[i] / length : Vec3(0.0f);
            bent[3 * i] = direction.x, bent[3 * i + 1] = direction.y, bent[3 * i + 2] = direction.z;
        }
}

}
