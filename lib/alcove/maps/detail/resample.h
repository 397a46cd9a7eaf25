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

/// `values`: row by row, `channels` per texel. Along each axis, new texels are means over their area if the image gets
/// smaller, and interpolated if it gets larger; borders do not wrap around.
std::vector<float> resample(std::span<const float> values, std::size_t channels, MapSize from, MapSize to);

}
