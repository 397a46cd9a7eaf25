/// Builds OpenVDB level sets from a band.
#pragma once

#include "alcove/grid/detail/band.h"

#include <array>
#include <span>
#include <vector>

namespace alcove {

/// The nearest triangles of the voxels of a brick, z fastest.
struct NearestOfBrick {
    Index3 low;
    std::array<std::uint32_t, brick_volume> triangle; ///< set in the band
    std::array<float, brick_volume> distance;         ///< signed, voxels; plus or minus the band width outside the band
};

/// The level of the given stride, with values multiplied by `value_scale` and the inside of solids filled. Indices are
/// those of the band plus `first` / stride, which is a multiple of brick_size. Reuses the distances of `finer`, the
/// level of half the stride, if given. Sets only grid, active_voxels and bytes. If `nearest` is given, adds the nearest
/// triangles of the voxels whose distance `finer` did not have, brick by brick.
LevelSet level_set(const Band& band, int stride, double value_scale, const Index3& first = Index3(0),
                   const LevelSet* finer = nullptr, std::vector<NearestOfBrick>* nearest = nullptr);

/// A level that consists of some bricks, with a leaf for each, even where no voxel is in the band. Elsewhere, values
/// are unknown.
LevelSet partial_level_set(const Band& band, std::span<const BandBlock> bricks, int stride, double value_scale);

}
