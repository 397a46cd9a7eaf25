#include "alcove/mesh/detail/srgb.h"
#include "alcove/mesh/files.h"

#include <algorithm>
#include <cmath>

namespace alcove {
std::vector<Color> grey_colors(std::span<const float> values, ColorEncoding encoding) {
    std::vector<Color> colors;
    colors.reserve(values.size());
    for (const float value : values) {
        const double clamped = std::clamp(double(value), 0.0, 1.0);
        const double encoded = encoding == ColorEncoding::srgb ? encode_srgb(clamped) : clamped;
        const auto grey = static_cast<std::uint8_t>(std::lround(255.0 * encoded));
        colors.push_back({grey, grey, grey, 255});
    }
    return colors;
}

}
