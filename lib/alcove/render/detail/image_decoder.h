/// Code that the decoders of the image formats share.
#pragma once

#include "alcove/render/detail/decoded_image.h"

namespace alcove {

/// Checks the memory that decoding an image takes. \throw LimitError if it is more than memory_limit().
void check_memory(const DecodedImage& image, const std::string& name);

bool is_png(std::string_view bytes);
DecodedImage decode_png(std::string_view bytes, const std::string& name, Decode what);
bool is_jpeg(std::string_view bytes);
DecodedImage decode_jpeg(std::string_view bytes, const std::string& name, Decode what);

}
