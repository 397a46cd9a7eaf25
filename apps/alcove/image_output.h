/// The image file that a verb writes: its name, what it shows and how.
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
    std::string precision = "half";
};

/// Adds -o, --pass and --precision.
void add_image_options(CLI::App& verb, ImageRequest& request);

class ImageOutput {
  public:
    /// \throw UsageError for what no image can be; IoError where none can be written: before any work.
    explicit ImageOutput(const ImageRequest& request);

    PassSet passes() const { return passes_; }
    /// The name of a frame of a sequence, counted from 1: its number before the extension, as wide as that of the last
    /// one, but at least four digits.
    std::string frame_file(int frame, int frames) const;
    /// Written whole or not at all. `comments` go where the file has a place for them. \throw IoError.
    void write(const Image& image, const std::string& file, const Camera& camera,
               const std::string& comments) const;

  private:
    std::string file_;
    bool png_;
    PassSet passes_;
    Precision precision_;
};

}
