#include "alcove/occlusion/detail/touched_surfels.h"

#include "alcove/base/detail/closest_point.h"
#include "alcove/base/parallel.h"
#include "alcove/occlusion/detail/surfel_cells.h"
#include "alcove/occlusion/detail/triangle_pairs.h"

#include <algorithm>
#include <atomic>

namespace alcove {
namespace {

Bounds bounds_of(const Vec3* positions, const TrianglePair& pair, float margin) {
    Bounds bounds{positions[pair[0]], positions[pair[0]]};
    for (const std::uint32_t v : {pair[1], pair[2], pair[3]})
        bounds.add(positions[v]);
    return {bounds.low - margin, bounds.high + margin};
}

/// The cell size that suits the pairs: twice the median of the largest extents, over a sample of the pairs.
float cell_for(const Vec3* positions, std::span<const TrianglePair> pairs) {
    constexpr std::size_t sample = 1024;
    std::vector<float> sizes;
    for (std::size_t i = 0; i < pairs.size(); i += std::max<std::size_t>(pairs.size() / sample, 1)) {
        const Bounds bounds = bounds_of(positions, pairs[i], 0.0f);
        const Vec3 size = bounds.high - bounds.low;
        sizes.push_back(std::max({size.x, size.y, size.z}));
    }
    const auto median = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), median, sizes.end());
    return 2.0f * *median;
}

/// Whether the plane through some edge, at right angles to the triangle, separates the point from the triangle, and the
/// point is farther than `distance` from that plane. This is true of most points, and the test takes a third of the
/// time of closest_on_triangle().
bool is_beside(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p, double distance) {
    const Vec3d normal = glm::cross(b - a, c - a);
    const auto beyond = [&](const Vec3d& from, const Vec3d& to) {
        const Vec3d out = glm::cross(to - from, normal);
        const double along = glm::dot(out, p - from);
        return along > 0.0 && along * along > distance * distance * glm::dot(out, out);
    };
    return beyond(a, b) || beyond(b, c) || beyond(c, a);
}

}

std::optional<std::vector<std::uint32_t>> find_touched(std::span<const Surfel> surfels, const RaySurface& surface,
                                                       float offset, const IsOwnFace& is_own) {
    constexpr std::size_t few = 4, grain = 4096;
    constexpr double cells_per_surfel = 8.0; // with more, a search around each surfel is faster
    const Vec3* const positions = surface.positions();
    const std::span<const TrianglePair> pairs = surface.pairs();
    if (pairs.empty() || few * surfels.size() < pairs.size())
        return {};
    if (std::none_of(surfels.begin(), surfels.end(), [](const Surfel& s) { return s.has_normal(); }))
        return std::vector<std::uint32_t>();
    const SurfelCells cells(surfels, std::max(cell_for(positions, pairs), 2.0f * offset));
    if (cells.is_sparse())
        return {};

    const SurfelCells::Points& points = cells.points();
    const auto touches = [&](const Triangle& t, std::uint32_t point) {
        if (is_own(points.surfel[point], t))
            return false;
        const Vec3d p(points.x[point], points.y[point], points.z[point]), a(positions[t[0]]), b(positions[t[1]]),
            c(positions[t[2]]);
        return !is_beside(a, b, c, p, offset) && glm::length(closest_on_triangle(a, b, c, p).offset) <= double(offset);
    };
    std::vector<std::uint8_t> touched(surfels.size(), 0);
    std::atomic<double> cells_met = 0.0;
    const double most_cells = cells_per_surfel * static_cast<double>(surfels.size());
    parallel_for(pairs.size(), grain, [&](std::size_t begin, std::size_t end) {
        double met = 0.0;
        SurfelCells::Found near;
        for (std::size_t i = begin; i < end; ++i) {
            const TrianglePair& pair = pairs[i];
            const Bounds bounds = bounds_of(positions, pair, offset);
            const SurfelCells::Cells searched = cells.cells_in(bounds);
            met += searched.count();
            if (met + cells_met.load(std::memory_order_relaxed) > most_cells)
                break;
            cells.find(searched, bounds, near);
            for (const std::uint32_t point : near.points())
                if (touches({pair[0], pair[1], pair[3]}, point) ||
                    (pair[2] != pair[3] && touches({pair[2], pair[3], pair[1]}, point)))
                    std::atomic_ref(touched[points.surfel[point]]).store(1, std::memory_order_relaxed);
        }
        cells_met += met;
    });
    if (cells_met > most_cells)
        return {};
    std::vector<std::uint32_t> found;
    for (std::size_t i = 0; i < touched.size(); ++i)
        if (touched[i] != 0)
            found.push_back(static_cast<std::uint32_t>(i));
    return found;
}

}
