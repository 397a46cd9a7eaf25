#include "alcove/base/types.h"
#include "alcove/render/detail/image_decoder.h"

#include <cstdio> // before jpeglib.h, which needs it
#include <fmt/format.h>
#include <jerror.h>
#include <jpeglib.h>

#include <algorithm>
#include <array>
#include <csetjmp>

namespace alcove {
namespace {

struct Decoder {
    jpeg_decompress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg_progress_mgr progress{};
    std::jmp_buf failed{};
    std::string failure;
    std::vector<JSAMPLE> row;
};

[[noreturn]] void fail(j_common_ptr jpeg) {
    auto& decoder = *static_cast<Decoder*>(jpeg->client_data);
    std::array<char, JMSG_LENGTH_MAX> message{};
    jpeg->err->format_message(jpeg, message.data());
    decoder.failure = message.data();
    std::longjmp(decoder.failed, 1);
}

/// Fails if an image ends too early: libjpeg only warns, and would leave the rest of the image grey.
void take_warning(j_common_ptr jpeg, int level) {
    const int code = jpeg->err->msg_code;
    if (level < 0 && (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER))
        fail(jpeg);
}

/// Limits the number of scans: each scan of a progressive JPEG takes as long as a whole image, however few bytes it
/// has.
void limit_scans(j_common_ptr jpeg) {
    constexpr int most = 100;
    auto& decoder = *static_cast<Decoder*>(jpeg->client_data);
    if (decoder.jpeg.input_scan_number > most) {
        decoder.failure = "it has too many scans";
        std::longjmp(decoder.failed, 1);
    }
}

// These functions hold no objects whose destructors a jump out of libjpeg would skip. They return false if libjpeg
// fails.

bool read_header(Decoder& decoder, std::string_view bytes, DecodedImage& image) {
    jpeg_decompress_struct& jpeg = decoder.jpeg;
    jpeg.err = jpeg_std_error(&decoder.errors);
    jpeg.client_data = &decoder;
    decoder.errors.error_exit = fail;
    decoder.errors.emit_message = take_warning;
    if (setjmp(decoder.failed))
        return false;
    jpeg_create_decompress(&jpeg);
    decoder.progress.progress_monitor = limit_scans;
    jpeg.progress = &decoder.progress;
    jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&jpeg, TRUE);
    image.width = static_cast<int>(jpeg.image_width);
    image.height = static_cast<int>(jpeg.image_height);
    return true;
}

bool read_rows(Decoder& decoder, DecodedImage& image) {
    jpeg_decompress_struct& jpeg = decoder.jpeg;
    if (setjmp(decoder.failed))
        return false;
    jpeg.out_color_space = JCS_RGB; // fails for CMYK
    jpeg_start_decompress(&jpeg);
    JSAMPROW row = decoder.row.data();
    while (jpeg.output_scanline < jpeg.output_height) {
        std::uint16_t* const to = image.values.data() + decoder.row.size() * jpeg.output_scanline;
        jpeg_read_scanlines(&jpeg, &row, 1);
        std::copy(decoder.row.begin(), decoder.row.end(), to);
    }
    return true;
}

}

bool is_jpeg(std::string_view bytes) {
    return bytes.starts_with("\xff\xd8\xff");
}

DecodedImage decode_jpeg(std::string_view bytes, const std::string& name, Decode what) {
    Decoder decoder;
    struct Cleanup {
        ~Cleanup() { jpeg_destroy_decompress(jpeg); }
        jpeg_decompress_struct* jpeg;
    } const cleanup{&decoder.jpeg};
    DecodedImage image;
    const auto require = [&](bool read) {
        if (!read)
            throw InputError(fmt::format("{}: is a JPEG that cannot be read ({}); write it again, or as PNG", name,
                                         decoder.failure));
    };
    require(read_header(decoder, bytes, image));
    check_memory(image, name);
    if (what == Decode::header)
        return image;
    decoder.row.resize(3 * static_cast<std::size_t>(image.width));
    image.values.resize(decoder.row.size() * static_cast<std::size_t>(image.height));
    require(read_rows(decoder, image));
    return image;
}

}
