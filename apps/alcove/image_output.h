/// The image file that a verb writes: its name, passes and precision.
#pragma once

#include "alcove/render/camera.h"
#include "alcove/render/image.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace alcove::cli {

struct ImageRequest {
    std::string file; ///< .exr or .png
    std::vector<std::string> passes;
    Precision precision = Precision::half;
};

/// Adds -o, --pass and --precision.
void add_image_options(CLI::App& verb, ImageRequest& request);

class ImageOutput {
  public:
    /// Checks the request. \throw UsageError for an unknown extension or pass, or several passes in a .png; IoError if
    /// the file cannot be written.
    explicit ImageOutput(const ImageRequest& request);

    PassSet passes() const { return passes_; }
    /// The file name of a frame, counted from 1. The number comes before the extension and has as many digits as the
    /// number of the last frame, but at least four.
    std::string frame_file(int frame, int frames) const;
    /// Writes the file completely or not at all. `comments` are stored in an .exr only. \throw IoError if it cannot be
    /// written.
    void write(const Image& image, const std::string& file, const Camera& camera, const std::string& comments) const;

  private:
    std::string file_;
    bool png_;
    PassSet passes_;
    Precision precision_;
};

}
