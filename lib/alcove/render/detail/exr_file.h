/// Writes an OpenEXR file from arrays of floats.
#pragma once

#include "alcove/render/image.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace alcove {

struct ExrChannel {
    std::string name;
    const float* values;                   ///< start at the first pixel
    std::size_t step = 1;                  ///< floats from one pixel to the next
    Precision precision = Precision::half; ///< values beyond the range of half are clamped
};

/// Writes the file with ZIP compression, completely or not at all. `has_camera` tells whether to store the camera
/// matrices of `header`. \throw IoError if it cannot be written.
void write_exr_file(int width, int height, std::span<const ExrChannel> channels, const ImageHeader& header,
                    bool has_camera, const std::filesystem::path& file);

}
