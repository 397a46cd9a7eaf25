/// Finds the surfels that touch faces other than their own, for many surfels at once.
#pragma once

#include "alcove/occlusion/detail/contacts.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace alcove {

/// The sorted indices of the surfels with a triangle within `offset` that is not one of their own faces. std::nullopt
/// if a search around each surfel is faster: for few surfels among many triangles, or for triangles that cross very
/// many cells of surfels. The result does not depend on the number of threads. Cost: about 0.1 µs per surfel, and 0.2
/// µs per pair of triangles.
std::optional<std::vector<std::uint32_t>> find_touched(std::span<const Surfel> surfels, const RaySurface& surface,
                                                       float offset, const IsOwnFace& is_own);

}
