/// Bakes points that are computed when they are needed, because there may be many.
#pragma once

#include "alcove/bake/bake.h"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace alcove {

/// Points to bake, each computed from its index. All functions must be thread-safe.
struct SurfacePoints {
    std::size_t count;
    std::function<SurfacePoint(std::size_t)> point;
    std::function<std::uint32_t(std::size_t)> face; ///< of the point
    /// If set, is called with the ao of all points so far and returns further points, which are baked with the same
    /// settings, until it returns none. Only for a bake with an error to meet.
    std::function<std::vector<SurfacePoint>(std::span<const float> ao)> more{};
    double error_share = 1.0; ///< the bake is planned for this share of the error to meet
};

/// Like bake(), for `points` and then the points that `more` returns. Baked::evaluated does not count those from
/// `more`.
Baked bake_points(const Mesh& mesh, const SurfacePoints& points, const BakeOptions& options);

}
