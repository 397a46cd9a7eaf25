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

constexpr std::size_t max_surfels = 4096;

/// The smallest distance, in voxels, between two faces of a solid, or between two sheets, that a grid resolves in any
/// alignment.
constexpr float resolved_solid = 1.5f, resolved_sheet = 2.5f;

/// The height above the surfel at which rays start, unit space: more than the rounding error of the faces around the
/// surfel.
constexpr float start = 2e-6f;

/// The first face that a ray hits.
struct NextFace {
    float distance = std::numeric_limits<float>::infinity();
    bool back = false; ///< seen from behind
};

/// The next face of each surfel along its normal (side 1) or against it (-1), within `reach` (unit space).
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
                    faces[at + i] = {rays.travelled[i], glm::dot(hits[i].normal, side * surfels[at + i].normal) > 0.0f};
        }
    });
    return faces;
}

/// Distance to a face that the grid cannot separate from the surfel's own face; infinite if there is none. In solids,
/// only the far side of the wall counts, and only if the surfel itself is not inside another solid.
float thickness(const NextFace& behind, const NextFace& in_front, bool two_sided) {
    if (two_sided)
        return std::min(behind.distance, in_front.distance);
    return behind.back && !in_front.back ? behind.distance : std::numeric_limits<float>::infinity();
}

}

ThinWalls thin_walls(std::span<const Surfel> surfels, const RaySurface& surface, float voxel, bool two_sided) {
    constexpr float across = 1.0f; // the size of the mesh, to find out whether a surfel is inside a solid
    const std::vector<Surfel> some = pick(surfels, evenly(spatial_order(surfels), max_surfels));
    const float resolved = two_sided ? resolved_sheet : resolved_solid;
    const std::vector<NextFace> behind = next_faces(some, surface, -1.0f, resolved * voxel);
    const std::vector<NextFace> in_front = next_faces(some, surface, 1.0f, two_sided ? resolved * voxel : across);
    std::vector<float> thin;
    for (std::size_t i = 0; i < some.size(); ++i)
        if (const float t = thickness(behind[i], in_front[i], two_sided); std::isfinite(t))
            thin.push_back(t);
    if (thin.empty())
        return {};
    const auto tenth = thin.begin() + static_cast<std::ptrdiff_t>(thin.size() / 10);
    std::nth_element(thin.begin(), tenth, thin.end());
    return {static_cast<double>(thin.size()) / static_cast<double>(some.size()), *tenth / resolved};
}

}
