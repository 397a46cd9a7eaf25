#include "alcove/render/image.h"

#include "alcove/atomic_file.h"
#include "alcove/errors.h"
#include "alcove/render/shading.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace alcove {
namespace {

/// OpenEXR goes back to fill in its table of offsets, so the file grows in memory.
class MemoryStream : public Imf::OStream {
  public:
    explicit MemoryStream(const std::string& name) : OStream(name.c_str()) {}

    void write(const char bytes[], int count) override {
        const std::size_t end = at_ + static_cast<std::size_t>(count);
        if (end > bytes_.size())
            bytes_.resize(end);
        std::memcpy(bytes_.data() + at_, bytes, static_cast<std::size_t>(count));
        at_ = end;
    }
    uint64_t tellp() override { return at_; }
    void seekp(uint64_t place) override { at_ = place; }
    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
    std::size_t at_ = 0;
};

void write_file(const std::filesystem::path& file, std::string_view bytes) {
    AtomicFile target(file);
    target.write(bytes);
    target.commit();
}

Imath::M44f row_vectors(const glm::dmat4& m) {
    Imath::M44f result;
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k)
            result[i][k] = static_cast<float>(m[i][k]);
    return result;
}

/// Light of the backdrop, from the top of the image (0) to its bottom (1): grey, a little darker below.
float backdrop(float down) {
    return 0.66f - 0.26f * down;
}

struct DepthRange {
    float nearest = far_depth, furthest = 0.0f;

    explicit DepthRange(const Image& image) {
        for (std::size_t i = 0; i < image.pixels(); ++i)
            if (image.alpha[i] > 0.0f) {
                nearest = std::min(nearest, image.depth[i]);
                furthest = std::max(furthest, image.depth[i]);
            }
    }
    float brightness(float depth) const {
        constexpr float darkest = 0.15f;
        return furthest > nearest ? 1.0f - (1.0f - darkest) * (depth - nearest) / (furthest - nearest) : 1.0f;
    }
};

Vec3 encoded(const Vec3& linear) {
    return {srgb_encoded(linear.x), srgb_encoded(linear.y), srgb_encoded(linear.z)};
}

/// What a PNG shows of a pixel, encoded, in [0, 1].
Vec3 shown(const Image& image, std::size_t i, Pass pass, float behind, const DepthRange& depths) {
    const float alpha = image.alpha[i];
    switch (pass) {
    case Pass::ao:
        return encoded(Vec3(image.ao[i] + (1.0f - alpha) * behind));
    case Pass::normal:
        return alpha * (0.5f + 0.5f * image.normal[i]) + (1.0f - alpha) * Vec3(srgb_encoded(behind));
    case Pass::depth:
        return Vec3(alpha > 0.0f ? alpha * depths.brightness(image.depth[i]) : 0.0f);
    case Pass::beauty:
        break;
    }
    return encoded(image.color[i] + (1.0f - alpha) * Vec3(behind));
}

}

Image::Image(int w, int h) : width(w), height(h) {
    const std::size_t count = static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
    color.assign(count, Vec3(0.0f));
    alpha.assign(count, 0.0f);
    ao.assign(count, 0.0f);
    depth.assign(count, far_depth);
    normal.assign(count, Vec3(0.0f));
}

void write_exr(const Image& image, const std::filesystem::path& file, const ImageHeader& description) {
    Imf::Header header(image.width, image.height, 1.0f, Imath::V2f(0.0f),
                       static_cast<float>(description.screen_window_width), Imf::INCREASING_Y,
                       Imf::ZIP_COMPRESSION);
    Imf::addWorldToCamera(header, row_vectors(description.world_to_camera));
    Imf::addWorldToNDC(header, row_vectors(description.world_to_ndc));
    Imf::addComments(header, description.comments);
    header.insert("software", Imf::StringAttribute(description.software));

    std::vector<Imath::half> half[5]; // R G B A, then ao
    for (auto& channel : half)
        channel.resize(image.pixels());
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        for (int c = 0; c < 3; ++c)
            half[c][i] = image.color[i][c];
        half[3][i] = image.alpha[i];
        half[4][i] = image.ao[i];
    }

    Imf::FrameBuffer pixels;
    const auto add = [&](const char* name, Imf::PixelType type, const void* values, std::size_t stride) {
        header.channels().insert(name, Imf::Channel(type));
        // OpenEXR takes pointers it only reads as pointers it may write.
        char* base = const_cast<char*>(static_cast<const char*>(values));
        pixels.insert(name, Imf::Slice(type, base, stride, stride * static_cast<std::size_t>(image.width)));
    };
    const char* const root[] = {"R", "G", "B", "A"};
    for (int c = 0; c < 4; ++c)
        add(root[c], Imf::HALF, half[c].data(), sizeof(Imath::half));
    for (const char* name : {"AO.R", "AO.G", "AO.B"})
        add(name, Imf::HALF, half[4].data(), sizeof(Imath::half));
    add("Z", Imf::FLOAT, image.depth.data(), sizeof(float));
    const char* const axes[] = {"N.X", "N.Y", "N.Z"};
    for (int c = 0; c < 3; ++c)
        add(axes[c], Imf::FLOAT, &image.normal.data()->x + c, sizeof(Vec3));

    MemoryStream stream(file.string());
    {
        Imf::OutputFile output(stream, header);
        output.setFrameBuffer(pixels);
        output.writePixels(image.height);
    }
    write_file(file, stream.bytes());
}

std::string encode_png(const Image& image, Pass pass) {
    const DepthRange depths(image);
    std::vector<std::uint8_t> rgb(3 * image.pixels());
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        const auto row = static_cast<float>(i / static_cast<std::size_t>(image.width));
        const Vec3 pixel =
            shown(image, i, pass, backdrop((row + 0.5f) / static_cast<float>(image.height)), depths);
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
        throw LimitError(std::string("the picture cannot be encoded as PNG: ") + png.message);
    bytes.resize(size);
    return bytes;
}

void write_png(const Image& image, const std::filesystem::path& file, Pass pass) {
    write_file(file, encode_png(image, pass));
}

ImageSummary summarize_image(const std::filesystem::path& file) {
    ImageSummary summary;
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_file(&png, file.c_str())) {
        summary = {"PNG", static_cast<int>(png.width), static_cast<int>(png.height), {}, {}};
        const char* const type = png.format & PNG_FORMAT_FLAG_LINEAR ? "16 bits" : "8 bits";
        if (png.format & PNG_FORMAT_FLAG_COLOR)
            summary.channels = {{"R", type}, {"G", type}, {"B", type}};
        else
            summary.channels = {{"Y", type}};
        if (png.format & PNG_FORMAT_FLAG_ALPHA)
            summary.channels.push_back({"A", type});
        png_image_free(&png);
        return summary;
    }
    try {
        const Imf::InputFile input(file.c_str());
        const Imf::Header& header = input.header();
        const Imath::Box2i& window = header.dataWindow();
        summary = {"EXR", window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, {}, {}};
        const char* const types[] = {"uint", "half", "float"};
        for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
            summary.channels.push_back({channel.name(), types[channel.channel().type]});
        for (auto attribute = header.begin(); attribute != header.end(); ++attribute)
            if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute()))
                summary.texts.emplace_back(attribute.name(), text->value());
    } catch (const std::exception&) {
        throw InputError(file.string() + ": is no readable EXR or PNG image: write it again");
    }
    return summary;
}

}
