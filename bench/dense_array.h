/// A baseline for map(): a scalar trilinear fetch from a dense array.
#pragma once

#include "alcove/base/types.h"

#include <cstddef>
#include <vector>

namespace alcove {

/// 128³ values, all 1: only the cost of the fetch matters.
class DenseArray {
  public:
    /// Coordinates are in voxels, at least 0, and wrap around.
    float at(const Vec3& p) const {
        const auto x = static_cast<std::size_t>(p.x), y = static_cast<std::size_t>(p.y),
                   z = static_cast<std::size_t>(p.z);
        const float tx = p.x - static_cast<float>(x), ty = p.y - static_cast<float>(y),
                    tz = p.z - static_cast<float>(z);
        const float* c = values_.data() + ((x & 126) * size + (y & 126)) * size + (z & 126);
        const auto mix = [](float a, float b, float t) { return a + (b - a) * t; };
        const auto along_z = [&](std::size_t at) { return mix(c[at], c[at + 1], tz); };
        const float near = mix(along_z(0), along_z(size), ty);
        const float far = mix(along_z(size * size), along_z(size * size + size), ty);
        return mix(near, far, tx);
    }

  private:
    static constexpr std::size_t size = 128;
    std::vector<float> values_ = std::vector<float>(size * size * size, 1.0f);
};

}
