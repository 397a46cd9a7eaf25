/// The vertex colours that ZBrush writes into comments of an OBJ file.
#pragma once

#include "alcove/base/types.h"

#include <string_view>
#include <vector>

namespace alcove {

struct MrgbColors {
    std::vector<Color> colors; ///< in the order of the vertices
    std::size_t lines = 0, damaged_lines = 0;
};

/// Reads the lines `#MRGB mmrrggbbmmrrggbb...`: a mask and a colour per vertex, with two hexadecimal digits each.
MrgbColors read_mrgb(std::string_view text);

}
