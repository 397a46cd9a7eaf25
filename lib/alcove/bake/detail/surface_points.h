/// Bakes points that are computed when they are needed, as there may be many.
#pragma once

#include "alcove/bake/bake.h"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace alcove {

/// Thread-safe functions of the index of a point.
struct SurfacePoints {
    std::size_t count;
    std::function<SurfacePoint(std::size_t)> point;
    std::function<std::uint32_t(std::size_t)> face; ///< that of the point
    /// If set, called with the ao of all points: returns further points, which get the same settings. Only for a bake
    /// with an error to meet.
    std::function<std::vector<SurfacePoint>(std::span<const float> ao)> more{};
};

/// As bake() of these points, and of those of `more` behind them, which Baked::evaluated does not count.
Baked bake_points(const Mesh& mesh, const SurfacePoints& points, const BakeOptions& options);

}
