#include "alcove/render/detail/texture.h"

#include "alcove/base/detail/input_file.h"
#include "alcove/base/detail/limits.h"

#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <fmt/format.h>
#include <png.h>

#include <cmath>
#include <optional>

namespace alcove {
namespace {

Texture texture_of_size(const std::filesystem::path& file, std::int64_t width, std::int64_t height) {
    if (static_cast<double>(width * height) * sizeof(Vec3) > memory_limit())
        throw LimitError(fmt::format("{}: {} x {} texels do not fit in memory: use a smaller texture, or raise "
                                     "--max-memory",
                                     file.string(), width, height));
    return {static_cast<int>(width), static_cast<int>(height),
            std::vector<Vec3>(static_cast<std::size_t>(width * height))};
}

/// std::nullopt if the file is not a PNG.
std::optional<Texture> read_png(const std::filesystem::path& file) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_file(&png, file.c_str()))
        return {};
    const std::unique_ptr<png_image, decltype(&png_image_free)> freed(&png, &png_image_free);
    png.flags |= PNG_IMAGE_FLAG_16BIT_sRGB; // no conversion from linear values
    png.format = PNG_FORMAT_RGBA;           // alpha is ignored: it may be a packed attribute
    Texture texture = texture_of_size(file, png.width, png.height);
    std::vector<png_byte> bytes(PNG_IMAGE_SIZE(png));
    if (!png_image_finish_read(&png, nullptr, bytes.data(), 0, nullptr))
        throw InputError(fmt::format("{}: is a damaged PNG ({}): write it again", file.string(), png.message));
    for (std::size_t i = 0; i < texture.texels.size(); ++i)
        texture.texels[i] = Vec3(bytes[4 * i], bytes[4 * i + 1], bytes[4 * i + 2]) / 255.0f;
    return texture;
}

Texture read_exr(const std::filesystem::path& file) {
    try {
        Imf::RgbaInputFile input(file.c_str());
        const Imath::Box2i window = input.dataWindow();
        Texture texture = texture_of_size(file, std::int64_t{window.max.x} - window.min.x + 1,
                                          std::int64_t{window.max.y} - window.min.y + 1);
        std::vector<Imf::Rgba> pixels(texture.texels.size());
        input.setFrameBuffer(pixels.data() - window.min.x - std::ptrdiff_t{window.min.y} * texture.width, 1,
                             static_cast<std::size_t>(texture.width));
        input.readPixels(window.min.y, window.max.y);
        for (std::size_t i = 0; i < pixels.size(); ++i)
            texture.texels[i] = {pixels[i].r, pixels[i].g, pixels[i].b};
        return texture;
    } catch (const LimitError&) {
        throw;
    } catch (const std::exception&) {
        throw InputError(file.string() + ": is not a readable PNG or EXR image: write it again");
    }
}

}

Vec3 Texture::at(const Vec2& uv) const {
    const auto cell = [](float position, int size) {
        const int whole = static_cast<int>(position) % size;
        return whole < 0 ? whole + size : whole;
    };
    const Vec2 repeated = uv - glm::floor(uv); // before it is scaled: UVs may be huge
    const float x = repeated.x * static_cast<float>(width) - 0.5f,
                y = (1.0f - repeated.y) * static_cast<float>(height) - 0.5f;
    const float left = std::floor(x), top = std::floor(y), right_share = x - left, lower_share = y - top;
    const auto texel = [&](float column, float row) {
        return texels[static_cast<std::size_t>(cell(row, height)) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(cell(column, width))];
    };
    return (1.0f - lower_share) * ((1.0f - right_share) * texel(left, top) + right_share * texel(left + 1.0f, top)) +
           lower_share *
               ((1.0f - right_share) * texel(left, top + 1.0f) + right_share * texel(left + 1.0f, top + 1.0f));
}

Texture read_texture(const std::filesystem::path& file) {
    check_input_file(file);
    if (std::optional<Texture> texture = read_png(file))
        return std::move(*texture);
    return read_exr(file);
}

}
