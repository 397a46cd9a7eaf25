#include "alcove/render/detail/decoded_image.h"

#include "alcove/base/detail/limits.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"
#include "alcove/render/detail/image_decoder.h"

#include <fmt/format.h>

namespace alcove {

void check_memory(const DecodedImage& image, const std::string& name) {
    constexpr double bytes_per_value = 6.0; // 2 as read, 2 as a number, 2 for the coefficients of a progressive JPEG
    const double bytes = bytes_per_value * image.channels * image.width * image.height;
    if (bytes > memory_limit())
        throw LimitError(fmt::format("{}: {} x {} pixels take about {}, more than the limit of {}: use a smaller "
                                     "image, or raise --max-memory",
                                     name, image.width, image.height, bytes_text(bytes), bytes_text(memory_limit())));
}

DecodedImage decode_image(std::string_view bytes, const std::string& name, Decode what) {
    if (is_png(bytes))
        return decode_png(bytes, name, what);
    if (is_jpeg(bytes))
        return decode_jpeg(bytes, name, what);
    throw InputError(name + ": is neither a PNG nor a JPEG image; convert it to one of them");
}

}
