#include "alcove/accuracy/thin_walls.h"

#include "alcove/accuracy/subset.h"
#include "alcove/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace alcove {
namespace {

constexpr std::size_t most_surfels = 4096;

/// Voxels between the faces of a solid, and between sheets, that are told however they lie in the grid.
constexpr float told_of_solids = 1.5f, told_of_sheets = 2.0f;

/// Where rays start, unit space: beyond the rounding of the faces around the surfel.
constexpr float start = 2e-6f;

/// Of each surfel along its normal, or against it, to the next face; infinite where that is further than `reach`.
std::vector<float> distances(const std::vector<Surfel>& surfels, const RaySurface& surface, float reach,
                             float side) {
    std::vector<float> all(surfels.size(), std::numeric_limits<float>::infinity());
    parallel_for(surfels.size(), RayBatch::capacity, [&](std::size_t begin, std::size_t end) {
        std::array<SurfaceHit, RayBatch::capacity> hits;
        for (std::size_t at = begin; at < end; at += RayBatch::capacity) {
            RayBatch rays;
            for (std::size_t i = at; i < std::min(end, at + RayBatch::capacity); ++i)
                rays.push_back({surfels[i].position, side * surfels[i].normal}, start);
            surface.find_nearest(rays, reach, hits);
            for (std::size_t i = 0; i < rays.count; ++i)
                if (rays.hit[i])
                    all[at + i] = rays.travelled[i];
        }
    });
    return all;
}

}

ThinWalls thin_walls(std::span<const Surfel> surfels, const RaySurface& surface, float voxel,
                     bool two_sided) {
    const std::vector<Surfel> some = pick(surfels, evenly(spatial_order(surfels), most_surfels));
    const float told = two_sided ? told_of_sheets : told_of_solids;
    std::vector<float> thickness = distances(some, surface, told * voxel, -1.0f);
    if (two_sided) {
        const std::vector<float> in_front = distances(some, surface, told * voxel, 1.0f);
        for (std::size_t i = 0; i < some.size(); ++i)
            thickness[i] = std::min(thickness[i], in_front[i]);
    }
    std::erase_if(thickness, [](float t) { return !std::isfinite(t); });
    if (thickness.empty())
        return {};
    const auto tenth = thickness.begin() + static_cast<std::ptrdiff_t>(thickness.size() / 10);
    std::nth_element(thickness.begin(), tenth, thickness.end());
    return {static_cast<double>(thickness.size()) / static_cast<double>(some.size()), *tenth / told};
}

}
