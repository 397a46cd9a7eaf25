#include "alcove/base/types.h"
#include "alcove/render/detail/image_decoder.h"

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstring>

namespace alcove {
namespace {

struct Decoder {
    std::string_view rest;
    std::string failure;
    DecodedImage image;
    std::vector<png_byte> bytes;
    std::vector<png_bytep> rows;
};

void give_bytes(png_structp png, png_bytep to, png_size_t length) {
    auto& rest = static_cast<Decoder*>(png_get_io_ptr(png))->rest;
    if (length > rest.size())
        png_error(png, "it ends too early");
    std::memcpy(to, rest.data(), length);
    rest.remove_prefix(length);
}

void take_failure(png_structp png, png_const_charp message) {
    static_cast<Decoder*>(png_get_error_ptr(png))->failure = message;
    png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

// These functions hold no objects whose destructors a jump out of libpng would skip. They return false if libpng fails.

bool read_header(Decoder& decoder, png_structp png, png_infop info) {
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_set_read_fn(png, &decoder, give_bytes);
    png_read_info(png, info);
    png_set_expand(png); // expands palettes, fewer than 8 bits, and transparent colours
    png_set_gray_to_rgb(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    decoder.image.width = static_cast<int>(png_get_image_width(png, info));
    decoder.image.height = static_cast<int>(png_get_image_height(png, info));
    decoder.image.channels = png_get_channels(png, info);
    decoder.image.bits = png_get_bit_depth(png, info);
    return true;
}

bool read_rows(Decoder& decoder, png_structp png) {
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_read_image(png, decoder.rows.data());
    return true;
}

/// libpng's structures for reading, freed by the destructor.
struct Reader {
    explicit Reader(Decoder& decoder)
        : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &decoder, take_failure, ignore)),
          info(png ? png_create_info_struct(png) : nullptr) {}
    ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;

    png_structp png;
    png_infop info;
};

}

bool is_png(std::string_view bytes) {
    return bytes.starts_with("\x89PNG\r\n\x1a\n");
}

DecodedImage decode_png(std::string_view bytes, const std::string& name, Decode what) {
    Decoder decoder{.rest = bytes, .failure = {}, .image = {}, .bytes = {}, .rows = {}};
    const Reader reader(decoder);
    const auto require = [&](bool read) {
        if (!read)
            throw InputError(fmt::format("{}: is a damaged PNG ({}); write it again", name, decoder.failure));
    };
    require(reader.info && read_header(decoder, reader.png, reader.info));
    DecodedImage& image = decoder.image;
    check_memory(image, name);
    if (what == Decode::header)
        return std::move(image);
    const auto height = static_cast<std::size_t>(image.height);
    const std::size_t per_row = png_get_rowbytes(reader.png, reader.info);
    decoder.bytes.resize(height * per_row);
    for (std::size_t y = 0; y < height; ++y)
        decoder.rows.push_back(decoder.bytes.data() + y * per_row);
    require(read_rows(decoder, reader.png));
    const std::size_t size = static_cast<std::size_t>(image.bits) / 8;
    image.values.resize(decoder.bytes.size() / size);
    for (std::size_t i = 0; i < image.values.size(); ++i)
        image.values[i] = size == 1 ? decoder.bytes[i]
                                    : static_cast<std::uint16_t>(decoder.bytes[2 * i] << 8 | decoder.bytes[2 * i + 1]);
    return std::move(image);
}

}
