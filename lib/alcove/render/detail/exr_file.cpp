#include "alcove/render/detail/exr_file.h"

#include "alcove/base/detail/atomic_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cstring>
#include <deque>

namespace alcove {
namespace {

/// OpenEXR seeks back to fill in its offset table, so the file is assembled in memory.
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

Imath::M44f row_vectors(const glm::dmat4& m) {
    Imath::M44f result;
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k)
            result[i][k] = static_cast<float>(m[i][k]);
    return result;
}

std::vector<Imath::half> halves_of(const ExrChannel& channel, std::size_t pixels) {
    constexpr float largest_half = 65504.0f;
    std::vector<Imath::half> halves(pixels);
    for (std::size_t i = 0; i < pixels; ++i)
        halves[i] = std::clamp(channel.values[i * channel.step], -largest_half, largest_half);
    return halves;
}

}

void write_exr_file(int width, int height, std::span<const ExrChannel> channels, const ImageHeader& description,
                    bool has_camera, const std::filesystem::path& file) {
    Imf::Header header(width, height, 1.0f, Imath::V2f(0.0f), static_cast<float>(description.screen_window_width),
                       Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
    // This level takes a third of the time of the default level, and its files are a twentieth larger.
    header.zipCompressionLevel() = 2;
    if (has_camera) {
        Imf::addWorldToCamera(header, row_vectors(description.world_to_camera));
        Imf::addWorldToNDC(header, row_vectors(description.world_to_ndc));
    }
    Imf::addComments(header, description.comments);
    header.insert("software", Imf::StringAttribute(description.software));

    const auto columns = static_cast<std::size_t>(width), pixels = columns * static_cast<std::size_t>(height);
    Imf::FrameBuffer buffer;
    const auto insert = [&](const std::string& name, Imf::PixelType type, const void* values, std::size_t stride) {
        header.channels().insert(name, Imf::Channel(type));
        // OpenEXR takes a writable pointer even for data it only reads.
        char* base = const_cast<char*>(static_cast<const char*>(values));
        buffer.insert(name, Imf::Slice(type, base, stride, stride * columns));
    };
    std::deque<std::vector<Imath::half>> halves; // a deque keeps their addresses stable
    const ExrChannel* converted = nullptr;       // successive channels with the same values share one
    for (const ExrChannel& channel : channels)
        if (channel.precision == Precision::single) {
            insert(channel.name, Imf::FLOAT, channel.values, channel.step * sizeof(float));
        } else {
            if (!converted || converted->values != channel.values)
                halves.push_back(halves_of(channel, pixels));
            converted = &channel;
            insert(channel.name, Imf::HALF, halves.back().data(), sizeof(Imath::half));
        }
    MemoryStream stream(file.string());
    {
        Imf::OutputFile output(stream, header);
        output.setFrameBuffer(buffer);
        output.writePixels(height);
    }
    AtomicFile target(file);
    target.write(stream.bytes());
    target.commit();
}

}
