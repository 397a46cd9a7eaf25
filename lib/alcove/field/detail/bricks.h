/// One level set as dense bricks under a flat index: what makes a map() cost a few nanoseconds.
///
/// A brick holds 9³ samples: the 8³ of an OpenVDB leaf and the first layer of its neighbours, so that all
/// eight corners of any cell lie in one brick. Trilinear interpolation inside the band, ±band beyond it.
#pragma once

#include "alcove/field/field.h"
#include "alcove/field/primitives.h"
#include "alcove/grid/grid_stack.h"

#include <cstdint>
#include <vector>

namespace alcove {

/// What sampling reads, as plain pointers: shared by the scalar and the SIMD sampler.
struct BrickView {
    static constexpr int cells = 8;           ///< along a side of a brick
    static constexpr int samples = cells + 1; ///< along a side of a brick
    static constexpr int stride = 736;        ///< floats from one brick to the next: 9³ and padding

    const std::int32_t* index; ///< position of each brick in `bricks`, x slowest
    const float* bricks;
    std::int32_t size[3]; ///< bricks along each axis
    float scale;          ///< samples a unit of length
    float offset[3];      ///< sample coordinate = scale · p + offset
};

/// Const use is thread-safe; copies share nothing.
class Bricks {
  public:
    /// Reads the OpenVDB grid of a level; `value_scale` turns its values into unit space.
    /// \throw LimitError if the index or the bricks would not fit 32-bit positions.
    Bricks(const LevelSet& level, float value_scale);

    BrickView view() const;
    float voxel() const { return voxel_; }
    /// Centre of the voxel of index (0, 0, 0).
    const Vec3& origin() const { return origin_; }
    /// Distances below this are right; above, the outermost voxel of the band spoils the interpolation.
    float usable() const { return usable_; }
    /// A box around the surface, no more than the band and a brick wider.
    const Cuboid& bounds() const { return bounds_; }
    std::size_t bytes() const { return (index_.size() + bricks_.size()) * sizeof(float); }

    /// The scalar twin of sample_bricks(), and its oracle.
    float map(const Vec3& p) const;

  private:
    std::vector<std::int32_t> index_;
    std::vector<float> bricks_;
    std::int32_t size_[3] = {0, 0, 0};
    float voxel_ = 0.0f, usable_ = 0.0f;
    Vec3 origin_{0.0f};
    Cuboid bounds_;
    Vec3 offset_{0.0f}; // sample coordinate = p / voxel + offset
};

/// distances[i] = trilinear interpolation at points[i], with the widest SIMD instructions of the running
/// machine. Points must be finite; those outside the index read the value of its border.
void sample_bricks(const BrickView& view, const Points& points, float* distances);

}
