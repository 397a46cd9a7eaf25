/// Encodes rows of numbers as PNG, without a colour space: for data rather than pictures.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace alcove {

/// A text in the file. The keywords "Software" and "Comment" are standard.
struct PngText {
    const char* keyword;
    std::string text;
};

/// `channels` is 1, 2, 3 or 4: grey, grey and alpha, RGB, RGBA. `bits` is 8 or 16. `values` are in [0, 65535], or in
/// [0, 255] for 8 bits. \throw LimitError if the image is too large for a PNG.
std::string encode_png_file(int width, int height, int channels, int bits, std::span<const std::uint16_t> values,
                            std::span<const PngText> texts = {});

}
