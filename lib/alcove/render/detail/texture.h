/// An image that colours a surface by its UVs.
#pragma once

#include "alcove/base/types.h"

#include <filesystem>
#include <vector>

namespace alcove {

struct Texture {
    int width = 0, height = 0;
    std::vector<Vec3> texels; ///< row by row from the top, where v is 1

    /// The colour at a UV, interpolated bilinearly. The texture repeats outside the unit square.
    Vec3 at(const Vec2& uv) const;
};

/// Reads a PNG or EXR. Values are used without sRGB decoding, because a map holds data: 255 or 65535 in a PNG is 1; an
/// EXR gives its R, G and B. \throw InputError if the file is neither, LimitError if it does not fit in memory.
Texture read_texture(const std::filesystem::path& file);

}
