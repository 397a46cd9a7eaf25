/// Decodes PNG and JPEG images in memory as data: ignores colour spaces, and checks the memory first.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace alcove {

struct DecodedImage {
    int width = 0, height = 0;
    int channels = 3; ///< RGB, or RGBA if the image has an alpha channel
    int bits = 8;     ///< 8 or 16
    /// Row by row from the top, in [0, 2^bits - 1]; empty if only the header was read.
    std::vector<std::uint16_t> values;
};

enum class Decode { header, all };

/// Decodes an image. Messages contain `name`. \throw InputError if the image is damaged or neither a PNG nor a JPEG,
/// LimitError if it does not fit in memory.
DecodedImage decode_image(std::string_view bytes, const std::string& name, Decode what);

}
