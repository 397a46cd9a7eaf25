/// Bakes points that are computed when they are needed, as there may be many.
#pragma once

#include "alcove/bake/bake.h"

#include <cstddef>
#include <functional>

namespace alcove {

/// Thread-safe functions of the index of a point.
struct SurfacePoints {
    std::size_t count;
    std::function<SurfacePoint(std::size_t)> point;
    std::function<std::uint32_t(std::size_t)> face; ///< that of the point
};

/// As bake() of these points.
Baked bake_points(const Mesh& mesh, const SurfacePoints& points, const BakeOptions& options);

}
