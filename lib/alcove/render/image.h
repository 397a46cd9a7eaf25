/// A rendered image and its files: OpenEXR with all passes, PNG with one.
#pragma once

#include "alcove/base/types.h"

#include <glm/mat4x4.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace alcove {

enum class Pass : std::uint8_t { beauty, ao, depth, normal, position, convexity, shadow, steps, object };

struct PassInfo {
    Pass pass;
    std::string_view name;
    std::string_view channels; ///< channel names in an OpenEXR file
    std::string_view summary;
};

inline constexpr std::array<PassInfo, 9> all_passes{{
    {Pass::beauty, "beauty", "R G B A", "shaded colour in linear light, multiplied by alpha"},
    {Pass::ao, "ao", "AO.R AO.G AO.B", "visibility, multiplied by alpha"},
    {Pass::depth, "depth", "Z", "distance along the view axis, scene units; 1e10 on the background"},
    {Pass::normal, "normal", "N.X N.Y N.Z", "scene directions; 0 on the background"},
    {Pass::position, "position", "P.X P.Y P.Z", "scene units; 0 on the background"},
    {Pass::convexity, "convexity", "Convexity.R Convexity.G Convexity.B",
     "0.5 flat, higher convex, lower concave, multiplied by alpha"},
    {Pass::shadow, "shadow", "Shadow.R Shadow.G Shadow.B", "share of the sunlight that arrives, multiplied by alpha"},
    {Pass::steps, "steps", "Steps.V", "map() calls per camera ray, without those shared by its tile"},
    {Pass::object, "object", "Object.V", "number of the object, counted from 1; 0 on the background"},
}};

using PassSet = EnumSet<Pass>;

constexpr PassSet operator|(Pass a, Pass b) {
    return PassSet(a) | b;
}

// Which channels must be computed for a set of passes.
constexpr bool need_ao(PassSet wanted) {
    return wanted.has(Pass::ao) || wanted.has(Pass::beauty);
}
constexpr bool need_convexity(PassSet wanted, bool has_edge_colors) {
    return wanted.has(Pass::convexity) || (wanted.has(Pass::beauty) && has_edge_colors);
}
constexpr bool need_shadow(PassSet wanted, bool casts_shadow) {
    return wanted.has(Pass::shadow) || (wanted.has(Pass::beauty) && casts_shadow);
}

/// The passes rendered by default.
inline constexpr PassSet standard_passes = Pass::beauty | Pass::ao | Pass::depth | Pass::normal;

/// Depth of the background.
inline constexpr float far_depth = 1e10f;

/// The passes of an image: one value per pixel, row by row from the top left. Passes not in `passes` are empty.
struct Image {
    int width = 0;
    int height = 0;
    PassSet passes;
    std::vector<float> alpha;                 ///< share of the pixel that the renderable covers; always present
    std::vector<Vec3> color;                  ///< linear light, multiplied by alpha
    std::vector<float> ao, convexity, shadow; ///< multiplied by alpha
    std::vector<float> steps;                 ///< mean of the samples
    // Values of the nearest sample.
    std::vector<float> depth;   ///< along the view axis, scene units; far_depth on the background
    std::vector<Vec3> normal;   ///< scene directions, unit length; zero on the background
    std::vector<Vec3> position; ///< scene units; zero on the background
    std::vector<float> object;  ///< object number, counted from 1; 0 on the background

    Image() = default;
    Image(int width, int height, PassSet passes = standard_passes);

    std::size_t pixels() const { return alpha.size(); }
    static double bytes_per_pixel(PassSet passes);
};

/// Metadata of an EXR header.
struct ImageHeader {
    glm::dmat4 world_to_camera{1.0};
    glm::dmat4 world_to_ndc{1.0};
    double screen_window_width = 1.0; ///< width of the image plane at depth 1
    std::string software;
    std::string comments;
};

enum class Precision { half, single };

/// Writes the channels of the image's passes (PassInfo::channels), and A, with ZIP compression. Depth, normal,
/// position, steps and object are always single precision. Writes the file completely or not at all. \throw IoError if
/// it cannot be written.
void write_exr(const Image& image, const std::filesystem::path& file, const ImageHeader& header,
               Precision precision = Precision::half);

/// Encodes one pass of the image as PNG, eight bits per channel, without alpha. Beauty is sRGB over a light backdrop;
/// ao and shadow are sRGB over white. The other passes, except depth and steps, are also shown over the light backdrop:
/// convexity unchanged, normals mapped from [−1, 1] to [0, 1], each coordinate of positions mapped from its range to
/// [0, 1], and objects in one colour each. In depth, near surfaces are white, far ones dark grey, and the background is
/// black. In steps, the highest count is white. \throw LimitError if the image is too large for a PNG.
std::string encode_png(const Image& image, Pass pass);

/// Writes encode_png() to a file, completely or not at all. \throw IoError if it cannot be written, and what
/// encode_png() throws.
void write_png(const Image& image, const std::filesystem::path& file, Pass pass);

/// The metadata of an image file.
struct ImageSummary {
    struct Channel {
        std::string name;
        std::string type; ///< "half", "float" or "uint"; "8 bits" or "16 bits" for PNG
    };
    std::string format; ///< "EXR" or "PNG"
    int width = 0;
    int height = 0;
    std::vector<Channel> channels;
    std::vector<std::pair<std::string, std::string>> texts; ///< name and value, such as software and comments
};

/// Reads the header of an EXR or PNG, without the pixels. \throw InputError if the file is neither or cannot be
/// opened.
ImageSummary summarize_image(const std::filesystem::path& file);

}
