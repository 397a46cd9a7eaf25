/// Values as grey vertex colours.
#pragma once

#include "alcove/types.h"

#include <span>
#include <vector>

namespace alcove {

enum class ColorEncoding {
    srgb, ///< bytes that decode to the value as sRGB (IEC 61966-2-1, 1999): what viewers and Blender assume
    raw,  ///< 255 × value
};

/// One opaque grey a value of [0, 1], rounded to the nearest byte; values beyond are clamped.
std::vector<Color> grey_colors(std::span<const float> values, ColorEncoding encoding = ColorEncoding::srgb);

}
