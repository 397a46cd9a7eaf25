/// Fills texels around islands, so that filtering and mip levels do not mix in the background.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace alcove {

/// For each texel, the index of the covered texel nearest to it, or its own index if none is within √2 · `margin`
/// texels, the diagonal of a square of side `margin`. Exact Euclidean distances (Felzenszwalb and Huttenlocher 2012).
/// Cost: about 20 ns per texel, whatever the margin.
std::vector<std::uint32_t> nearest_covered(std::span<const std::uint8_t> covered, int width, int height, int margin);

}
