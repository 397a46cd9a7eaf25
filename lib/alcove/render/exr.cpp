#include "alcove/base/detail/atomic_file.h"
#include "alcove/render/image.h"

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

constexpr float largest_half = 65504.0f;

/// The channels of a file and the frame buffer that OpenEXR reads them from.
class Channels {
  public:
    Channels(Imf::Header& header, std::size_t width, std::size_t pixels)
        : header_(header), width_(width), pixels_(pixels) {}

    /// Adds every `step`th value as a channel, once under each name.
    void add(std::initializer_list<const char*> names, const float* values, std::size_t step, Precision precision) {
        if (precision == Precision::single) {
            insert(names, Imf::FLOAT, values, step * sizeof(float));
            return;
        }
        auto& halves = halves_.emplace_back(pixels_);
        for (std::size_t i = 0; i < pixels_; ++i)
            halves[i] = std::clamp(values[i * step], -largest_half, largest_half);
        insert(names, Imf::HALF, halves.data(), sizeof(Imath::half));
    }
    const Imf::FrameBuffer& buffer() const { return buffer_; }

  private:
    void insert(std::initializer_list<const char*> names, Imf::PixelType type, const void* values, std::size_t stride) {
        // OpenEXR takes a writable pointer even for data it only reads.
        char* base = const_cast<char*>(static_cast<const char*>(values));
        for (const char* name : names) {
            header_.channels().insert(name, Imf::Channel(type));
            buffer_.insert(name, Imf::Slice(type, base, stride, stride * width_));
        }
    }

    Imf::Header& header_;
    std::size_t width_, pixels_;
    Imf::FrameBuffer buffer_;
    std::deque<std::vector<Imath::half>> halves_; // a deque keeps their addresses stable
};

void add_vectors(Channels& channels, std::array<const char*, 3> names, const std::vector<Vec3>& values,
                 Precision precision) {
    for (std::size_t c = 0; c < 3; ++c)
        channels.add({names[c]}, &values.front().x + c, 3, precision);
}

}

void write_exr(const Image& image, const std::filesystem::path& file, const ImageHeader& description,
               Precision precision) {
    Imf::Header header(image.width, image.height, 1.0f, Imath::V2f(0.0f),
                       static_cast<float>(description.screen_window_width), Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
    // A third of the time of the default level, for files a twentieth larger.
    header.zipCompressionLevel() = 2;
    Imf::addWorldToCamera(header, row_vectors(description.world_to_camera));
    Imf::addWorldToNDC(header, row_vectors(description.world_to_ndc));
    Imf::addComments(header, description.comments);
    header.insert("software", Imf::StringAttribute(description.software));

    Channels channels(header, static_cast<std::size_t>(image.width), image.pixels());
    channels.add({"A"}, image.alpha.data(), 1, precision);
    if (image.passes.has(Pass::beauty))
        add_vectors(channels, {"R", "G", "B"}, image.color, precision);
    if (image.passes.has(Pass::ao))
        channels.add({"AO.R", "AO.G", "AO.B"}, image.ao.data(), 1, precision);
    if (image.passes.has(Pass::convexity))
        channels.add({"Convexity.R", "Convexity.G", "Convexity.B"}, image.convexity.data(), 1, precision);
    if (image.passes.has(Pass::shadow))
        channels.add({"Shadow.R", "Shadow.G", "Shadow.B"}, image.shadow.data(), 1, precision);
    if (image.passes.has(Pass::depth))
        channels.add({"Z"}, image.depth.data(), 1, Precision::single);
    if (image.passes.has(Pass::normal))
        add_vectors(channels, {"N.X", "N.Y", "N.Z"}, image.normal, Precision::single);
    if (image.passes.has(Pass::position))
        add_vectors(channels, {"P.X", "P.Y", "P.Z"}, image.position, Precision::single);
    if (image.passes.has(Pass::steps))
        channels.add({"Steps.V"}, image.steps.data(), 1, Precision::single);
    if (image.passes.has(Pass::object))
        channels.add({"Object.V"}, image.object.data(), 1, Precision::single);

    MemoryStream stream(file.string());
    {
        Imf::OutputFile output(stream, header);
        output.setFrameBuffer(channels.buffer());
        output.writePixels(image.height);
    }
    AtomicFile target(file);
    target.write(stream.bytes());
    target.commit();
}

}
