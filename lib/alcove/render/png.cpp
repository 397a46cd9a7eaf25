#include "alcove/base/detail/atomic_file.h"
#include "alcove/base/types.h"
#include "alcove/render/image.h"
#include "alcove/render/renderer.h"

#include <png.h>

#include <algorithm>
#include <cmath>

namespace alcove {
namespace {

/// Linear grey of the backdrop, from the top of the image (0) to its bottom (1): slightly darker toward the bottom.
float backdrop(float down) {
    return 0.66f - 0.26f * down;
}

Vec3 encoded(const Vec3& linear) {
    return {srgb_encoded(linear.x), srgb_encoded(linear.y), srgb_encoded(linear.z)};
}

/// A distinct colour for each object number: hues a golden ratio apart.
Vec3 color_of(float object) {
    const float hue = 6.0f * std::fmod(0.618034f * object, 1.0f);
    const auto channel = [&](float at) {
        const float away = std::fabs(std::fmod(hue - at + 9.0f, 6.0f) - 3.0f);
        return 0.25f + 0.65f * std::clamp(2.0f - away, 0.0f, 1.0f);
    };
    return {channel(0.0f), channel(2.0f), channel(4.0f)};
}

/// Computes the encoded colour of each pixel of a PNG, in [0, 1].
class PngPixels {
  public:
    PngPixels(const Image& image, Pass pass) : image_(image), pass_(pass) {
        for (std::size_t i = 0; i < image.pixels(); ++i)
            if (image.alpha[i] > 0.0f) {
                min_ = glm::min(min_, ranged(i));
                max_ = glm::max(max_, ranged(i));
            }
    }

    Vec3 operator()(std::size_t i, float behind) const {
        const float alpha = image_.alpha[i], left = 1.0f - alpha;
        const auto over = [&](const Vec3& color) { return color + left * Vec3(srgb_encoded(behind)); };
        switch (pass_) {
        case Pass::beauty:
            return encoded(image_.color[i] + left * Vec3(behind));
        case Pass::ao:
            return encoded(Vec3(image_.ao[i] + left)); // the background is open
        case Pass::shadow:
            return encoded(Vec3(image_.shadow[i] + left));
        case Pass::convexity:
            return over(Vec3(image_.convexity[i]));
        case Pass::normal:
            return over(alpha * (0.5f + 0.5f * image_.normal[i]));
        case Pass::position:
            return over(alpha * share(i));
        case Pass::object:
            return over(alpha * color_of(image_.object[i]));
        case Pass::depth:
            return Vec3(alpha > 0.0f ? alpha * (1.0f - 0.85f * share(i).x) : 0.0f);
        case Pass::steps:
            return Vec3(share(i).x);
        }
        return Vec3(0.0f);
    }

  private:
    /// The value of a pass that is shown relative to its range over all pixels.
    Vec3 ranged(std::size_t i) const {
        switch (pass_) {
        case Pass::depth:
            return Vec3(image_.depth[i]);
        case Pass::position:
            return image_.position[i];
        case Pass::steps:
            return Vec3(image_.steps[i]);
        default:
            return Vec3(0.0f);
        }
    }
    Vec3 share(std::size_t i) const {
        Vec3 result(0.0f);
        for (int c = 0; c < 3; ++c)
            if (max_[c] > min_[c])
                result[c] = std::clamp((ranged(i)[c] - min_[c]) / (max_[c] - min_[c]), 0.0f, 1.0f);
        return result;
    }

    const Image& image_;
    Pass pass_;
    Vec3 min_{std::numeric_limits<float>::max()}, max_{std::numeric_limits<float>::lowest()};
};

}

std::string encode_png(const Image& image, Pass pass) {
    const PngPixels pixels(image, pass);
    std::vector<std::uint8_t> rgb(3 * image.pixels());
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        const auto row = static_cast<float>(i / static_cast<std::size_t>(image.width));
        const Vec3 pixel = pixels(i, backdrop((row + 0.5f) / static_cast<float>(image.height)));
        for (int c = 0; c < 3; ++c)
            rgb[3 * i + static_cast<std::size_t>(c)] =
                static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(pixel[c], 0.0f, 1.0f)));
    }

    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.width);
    png.height = static_cast<png_uint_32>(image.height);
    png.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::string bytes(size, '\0');
    if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, rgb.data(), 0, nullptr))
        throw LimitError(std::string("the image cannot be encoded as PNG: ") + png.message);
    bytes.resize(size);
    return bytes;
}

void write_png(const Image& image, const std::filesystem::path& file, Pass pass) {
    AtomicFile target(file);
    target.write(encode_png(image, pass));
    target.commit();
}

}
