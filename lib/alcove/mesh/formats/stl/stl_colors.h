/// The colours of the facets of a binary STL file.
///
/// The 16 bits after a facet hold 5 bits per component, by one of two conventions:
///  - VisCAM: bit 15 marks a valid colour; blue is in the low bits.
///  - Magics: the header holds "COLOR=" and the red, green, blue and alpha of the whole part. A facet has this colour
///    if its bit 15 is set, or if the bits of all facets are 0. Otherwise it has its own colour, with red in the low
///    bits.
#pragma once

#include "alcove/base/types.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alcove {

/// One colour per facet, or none if the file has none. `attributes` are the 16 bits of each facet. Appends a warning
/// about attributes that are not colours.
std::vector<Color> stl_colors(std::string_view header, std::span<const std::uint16_t> attributes,
                              std::vector<std::string>& warnings);

}
