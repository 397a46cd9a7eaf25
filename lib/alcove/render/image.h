/// A rendered picture and its files: OpenEXR with every pass, PNG of one.
#pragma once

#include "alcove/base/types.h"
#include "alcove/render/passes.h"

#include <glm/mat4x4.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace alcove {

/// Depth where nothing was hit.
inline constexpr float far_depth = 1e10f;

/// The passes of a picture, row after row from the top left; one value a pixel each. Those that it has not are empty.
struct Image {
    int width = 0;
    int height = 0;
    PassSet passes;
    std::vector<float> alpha; ///< share of the pixel that the renderable covers; there in any case
    std::vector<Vec3> color;  ///< linear light, multiplied by alpha
    std::vector<float> ao, convexity, shadow; ///< multiplied by alpha
    std::vector<float> steps;                 ///< mean of the samples
    // Of the nearest sample.
    std::vector<float> depth;   ///< along the view axis, scene units; far_depth where nothing is
    std::vector<Vec3> normal;   ///< scene directions, unit length; zero where nothing is
    std::vector<Vec3> position; ///< scene units; zero where nothing is
    std::vector<float> object;  ///< number of the object, counted from 1; 0 where nothing is

    Image() = default;
    Image(int width, int height, PassSet passes = standard_passes);

    std::size_t pixels() const { return alpha.size(); }
    static double bytes_per_pixel(PassSet passes);
};

/// What an EXR header says beside the picture.
struct ImageHeader {
    glm::dmat4 world_to_camera{1.0};
    glm::dmat4 world_to_ndc{1.0};
    double screen_window_width = 1.0; ///< of the image plane at depth 1
    std::string software;
    std::string comments;
};

enum class Precision { half, single };

/// Channels as passes.h names them, and A. Depth, normal, position, steps and object are single precision in any case;
/// ZIP compression. Written whole or not at all. \throw IoError if the file cannot be written.
void write_exr(const Image& image, const std::filesystem::path& file, const ImageHeader& header,
               Precision precision = Precision::half);

/// The bytes of a PNG of a pass that the image has, eight bits a channel, no alpha. Beauty, ao and shadow: sRGB over a
/// light backdrop. Convexity as it is, normals from [−1, 1] to [0, 1], and objects in colours of their own, over the
/// backdrop. Depth: near is white, far dark grey, nothing black. Steps: most are white. Positions: from the least to the
/// largest of each coordinate. \throw LimitError if the picture is too large for a PNG.
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
