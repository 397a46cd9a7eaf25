/// Reads PNG files without Alcove's reader, and without converting their values.
#pragma once

#include <png.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace alcove {

struct Png {
    png_uint_32 width = 0, height = 0;
    int depth = 0, color_type = 0;
    bool has_srgb = false, has_gamma = false;
    std::vector<int> values;
    std::map<std::string, std::string> texts;
};

inline Png read_png(const std::filesystem::path& file) {
    Png result;
    std::FILE* stream = std::fopen(file.c_str(), "rb");
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, stream);
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    png_get_IHDR(png, info, &result.width, &result.height, &result.depth, &result.color_type, nullptr, nullptr,
                 nullptr);
    result.has_srgb = png_get_valid(png, info, PNG_INFO_sRGB) != 0;
    result.has_gamma = png_get_valid(png, info, PNG_INFO_gAMA) != 0;
    png_bytepp rows = png_get_rows(png, info);
    const auto bytes = static_cast<std::size_t>(result.depth / 8);
    for (png_uint_32 y = 0; y < result.height; ++y)
        for (std::size_t i = 0; i < png_get_rowbytes(png, info); i += bytes)
            result.values.push_back(bytes == 1 ? rows[y][i] : 256 * rows[y][i] + rows[y][i + 1]);
    png_textp texts = nullptr;
    const int count = png_get_text(png, info, &texts, nullptr);
    for (int i = 0; i < count; ++i)
        result.texts[texts[i].key] = texts[i].text;
    png_destroy_read_struct(&png, &info, nullptr);
    std::fclose(stream);
    return result;
}

}
