#include "alcove/maps/detail/packed_texture.h"

#include "alcove/base/detail/limits.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"
#include "alcove/render/detail/decoded_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace alcove {

MapSize size_of(const GltfImage& image) {
    const DecodedImage header = decode_image(image.bytes, image.name, Decode::header);
    return {header.width, header.height};
}

void check_packing(const GltfImage& image, MapSize to) {
    constexpr double bytes_per_texel = 4.0 * (sizeof(float) + 2.0 * sizeof(std::uint16_t)); // as floats, and encoded
    const MapSize from = size_of(image);
    const double bytes = bytes_per_texel * (double(from.width) * from.height + double(to.width) * to.height);
    if (bytes > memory_limit())
        throw LimitError(fmt::format("{}: packing {} x {} texels takes about {}, more than the limit of {}: use a "
                                     "smaller --size or image, or raise --max-memory",
                                     image.name, to.width, to.height, bytes_text(bytes), bytes_text(memory_limit())));
}

std::string pack_occlusion(std::span<const float> ao, MapSize map, const GltfImage& image, MapSize to,
                           std::span<const PngText> texts) {
    DecodedImage decoded = decode_image(image.bytes, image.name, Decode::all);
    const auto channels = static_cast<std::size_t>(decoded.channels);
    const auto most = static_cast<float>((1 << decoded.bits) - 1);
    const MapSize from{decoded.width, decoded.height};
    if (from != to) {
        const std::vector<float> floats(decoded.values.begin(), decoded.values.end());
        const std::vector<float> resized = resample(floats, channels, from, to);
        decoded.values.resize(resized.size());
        std::transform(resized.begin(), resized.end(), decoded.values.begin(),
                       [](float value) { return static_cast<std::uint16_t>(std::lround(value)); });
    }
    const std::vector<float> red = resample(ao, 1, map, to);
    for (std::size_t i = 0; i < red.size(); ++i)
        decoded.values[channels * i] = static_cast<std::uint16_t>(std::lround(most * std::clamp(red[i], 0.0f, 1.0f)));
    return encode_png_file(to.width, to.height, decoded.channels, decoded.bits, decoded.values, texts);
}

}
