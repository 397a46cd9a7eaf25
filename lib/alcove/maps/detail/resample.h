/// Changes the size of an image.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace alcove {

/// The size of an image, in texels.
struct MapSize {
    int width = 0, height = 0;
    auto operator<=>(const MapSize&) const = default;
};

/// `values` has `channels` values per texel, row by row. Along each axis, a new texel is the mean over its area if the
/// image gets smaller, and is interpolated if the image gets larger. Borders do not wrap around.
std::vector<float> resample(std::span<const float> values, std::size_t channels, MapSize from, MapSize to);

}
