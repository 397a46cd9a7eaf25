/// A rendered picture and its files: OpenEXR with every pass, PNG of one.
#pragma once

#include "alcove/types.h"

#include <glm/mat4x4.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace alcove {

/// Depth where nothing was hit.
inline constexpr float far_depth = 1e10f;

/// All passes of a picture, row after row from the top left; one value a pixel each.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<Vec3> color;  ///< linear light, multiplied by alpha
    std::vector<float> alpha; ///< share of the pixel that the subject covers
    std::vector<float> ao;    ///< visibility, multiplied by alpha
    std::vector<float>
        depth; ///< along the view axis, scene units, of the nearest sample; far_depth where none hit
    std::vector<Vec3> normal; ///< scene directions, unit length, of the nearest sample; zero where none hit

    Image() = default;
    Image(int width, int height);

    std::size_t pixels() const { return alpha.size(); }
    static constexpr double bytes_per_pixel = 2 * sizeof(Vec3) + 3 * sizeof(float);
};

enum class Pass { beauty, ao, normal, depth };

/// What an EXR header says beside the picture.
struct ImageHeader {
    glm::dmat4 world_to_camera{1.0};
    glm::dmat4 world_to_ndc{1.0};
    double screen_window_width = 1.0; ///< of the image plane at depth 1
    std::string software;
    std::string comments;
};

/// Channels R G B A (half) Z (float), N.X N.Y N.Z (float), AO.R AO.G AO.B (half); ZIP compression. Written
/// whole or not at all. \throw IoError if the file cannot be written.
void write_exr(const Image& image, const std::filesystem::path& file, const ImageHeader& header);

/// The bytes of a PNG, eight bits a channel, no alpha. Beauty and ao: sRGB over a light backdrop. Normal: each
/// component from [−1, 1] to [0, 1], over the backdrop. Depth: near is white, far dark grey, nothing black.
/// \throw LimitError if the picture is too large for a PNG.
std::string encode_png(const Image& image, Pass pass);

/// encode_png() to a file, written whole or not at all. \throw IoError if the file cannot be written.
void write_png(const Image& image, const std::filesystem::path& file, Pass pass);

/// What an image file says of itself.
struct ImageSummary {
    struct Channel {
        std::string name;
        std::string type; ///< "half", "float", "uint"; of a PNG "8 bits" or "16 bits"
    };
    std::string format; ///< "EXR" or "PNG"
    int width = 0;
    int height = 0;
    std::vector<Channel> channels;
    std::vector<std::pair<std::string, std::string>> texts; ///< such as software and comments, by name
};

/// Reads the header of an EXR or PNG, no pixels. \throw InputError if the file is neither or cannot be
/// opened.
ImageSummary summarize_image(const std::filesystem::path& file);

}
