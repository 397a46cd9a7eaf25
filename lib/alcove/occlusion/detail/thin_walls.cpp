#include "alcove/occlusion/detail/thin_walls.h"

#include "alcove/base/parallel.h"
#include "alcove/field/detail/trace.h"
#include "alcove/occlusion/detail/subset.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace alcove {
namespace {

constexpr std::size_t most_surfels = 4096;

/// Voxels between the faces of a solid, and between sheets, that are told however they lie in the grid.
constexpr float told_of_solids = 1.5f, told_of_sheets = 2.5f;

/// Where rays start, unit space: beyond the rounding of the faces around the surfel.
constexpr float start = 2e-6f;

/// The next face of a ray.
struct NextFace {
    float distance = std::numeric_limits<float>::infinity();
    bool back = false; ///< seen from behind
};

/// Of each surfel along its normal (side 1) or against it (-1), as far as `reach`.
std::vector<NextFace> next_faces(const std::vector<Surfel>& surfels, const RaySurface& surface, float side,
                                 float reach) {
    std::vector<NextFace> faces(surfels.size());
    parallel_for(surfels.size(), RayBatch::capacity, [&](std::size_t begin, std::size_t end) {
        std::array<SurfaceHit, RayBatch::capacity> hits;
        for (std::size_t at = begin; at < end; at += RayBatch::capacity) {
            RayBatch rays;
            for (std::size_t i = at; i < std::min(end, at + RayBatch::capacity); ++i)
                rays.push_back({surfels[i].position, side * surfels[i].normal}, start);
            surface.find_nearest(rays, reach, hits);
            for (std::size_t i = 0; i < rays.count; ++i)
                if (rays.hit[i])
                    faces[at + i] = {rays.travelled[i],
                                     glm::dot(hits[i].normal, side * surfels[at + i].normal) > 0.0f};
        }
    });
    return faces;
}

/// How near another face is that the grid does not tell from the surfel's own. In solids only a back, and not of what
/// the surfel itself is inside of.
float thickness(const NextFace& behind, const NextFace& in_front, bool two_sided) {
    if (two_sided)
        return std::min(behind.distance, in_front.distance);
    return behind.back && !in_front.back ? behind.distance : std::numeric_limits<float>::infinity();
}

}

ThinWalls thin_walls(std::span<const Surfel> surfels, const RaySurface& surface, float voxel,
                     bool two_sided) {
    constexpr float across = 1.0f; // the surface
    const std::vector<Surfel> some = pick(surfels, evenly(spatial_order(surfels), most_surfels));
    const float told = two_sided ? told_of_sheets : told_of_solids;
    const std::vector<NextFace> behind = next_faces(some, surface, -1.0f, told * voxel);
    const std::vector<NextFace> in_front = next_faces(some, surface, 1.0f, two_sided ? told * voxel : across);
    std::vector<float> thin;
    for (std::size_t i = 0; i < some.size(); ++i)
        if (const float t = thickness(behind[i], in_front[i], two_sided); std::isfinite(t))
            thin.push_back(t);
    if (thin.empty())
        return {};
    const auto tenth = thin.begin() + static_cast<std::ptrdiff_t>(thin.size() / 10);
    std::nth_element(thin.begin(), tenth, thin.end());
    return {static_cast<double>(thin.size()) / static_cast<double>(some.size()), *tenth / told};
}

}
