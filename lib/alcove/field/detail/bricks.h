/// Stores one level set as dense bricks with a flat index, so that a map() costs only a few nanoseconds.
///
/// A brick has 9³ samples: the 8³ of an OpenVDB leaf and the first layer of its neighbours, so that all eight
/// corners of any cell are in one brick. Interpolation is trilinear inside the band; beyond it the result is ± the
/// band width.
#pragma once

#include "alcove/field/field.h"
#include "alcove/field/primitives.h"
#include "alcove/grid/grid_stack.h"

#include <cstdint>
#include <vector>

namespace alcove {

/// The data for sampling as plain pointers.
struct BrickView {
    static constexpr int cells = 8;           ///< per side of a brick
    static constexpr int samples = cells + 1; ///< per side of a brick
    static constexpr int stride = 736;        ///< floats from one brick to the next: 9³ plus padding

    const std::int32_t* index; ///< index of each brick in `bricks`; x varies slowest
    const float* bricks;
    std::int32_t size[3]; ///< bricks along each axis
    float scale;          ///< samples per unit of length
    float offset[3];      ///< sample coordinate = scale · p + offset
};

/// The bricks of one level. Const use is thread-safe; copies share nothing.
class Bricks {
  public:
    /// A `partial` level has distances only where its leaves are; elsewhere, its values are huge.
    enum class Extent { whole, partial };

    /// Reads the OpenVDB grid of a level; `value_scale` converts its values to unit space.
    /// \throw LimitError if the index or the bricks exceed 32-bit offsets.
    Bricks(const LevelSet& level, float value_scale, Extent extent = Extent::whole);

    BrickView view() const;
    float voxel() const { return voxel_; }
    /// Centre of the voxel of index (0, 0, 0).
    const Vec3& origin() const { return origin_; }
    /// Distances below this limit are correct. Above it, interpolation includes saturated values from beyond the band.
    float usable() const { return usable_; }
    /// The same limit for the magnitudes of negative distances, behind the surface.
    float usable_inside() const { return usable_inside_; }
    /// A box around the surface. Its sides are at most the band plus a brick away from the surface.
    const Cuboid& bounds() const { return bounds_; }
    std::size_t bytes() const { return (index_.size() + bricks_.size()) * sizeof(float); }

    /// The scalar version of sample_bricks(), and the reference for its tests.
    float map(const Vec3& p) const;

  private:
    std::vector<std::int32_t> index_;
    std::vector<float> bricks_;
    std::int32_t size_[3] = {0, 0, 0};
    float voxel_ = 0.0f, usable_ = 0.0f, usable_inside_ = 0.0f;
    Vec3 origin_{0.0f};
    Cuboid bounds_;
    Vec3 offset_{0.0f}; // sample coordinate = p / voxel + offset
};

/// distances[i] = trilinear interpolation at points[i], with the widest SIMD instructions of the machine. Points
/// must be finite; those outside the index are clamped to its border.
void sample_bricks(const BrickView& view, const Points& points, float* distances);

}
