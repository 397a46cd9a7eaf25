/// Bakes points that are computed when they are needed, as there may be many.
#pragma once

#include "alcove/bake/bake.h"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace alcove {

/// Points to bake, computed from their index. All functions are thread-safe.
struct SurfacePoints {
    std::size_t count;
    std::function<SurfacePoint(std::size_t)> point;
    std::function<std::uint32_t(std::size_t)> face; ///< of the point
    /// If set, it is called with the ao of all points and returns further points, which are baked with the same
    /// settings. Only for a bake with an error to meet.
    std::function<std::vector<SurfacePoint>(std::span<const float> ao)> more{};
    double error_share = 1.0; ///< of the error to meet, the share to plan for
};

/// Like bake(), for `points` and then those that `more` returns. Baked::evaluated does not count those of `more`.
Baked bake_points(const Mesh& mesh, const SurfacePoints& points, const BakeOptions& options);

}
