/// Levels that are finer than a stack's finest and exist only where it does not resolve the surface.
#pragma once

#include "alcove/grid/detail/band.h"
#include "alcove/grid/detail/unresolved.h"

#include <vector>

namespace alcove {

/// The input of the partial levels, in voxels of the finest whole level.
struct PartialLevelsSource {
    Surface surface; ///< all triangles; no coordinate is below 0
    Sign sign;
    BandWidth width;        ///< of every level
    double voxel;           ///< unit space
    Vec3d origin;           ///< of index (0, 0, 0) on all levels, unit space
    double value_scale;     ///< value of a distance of one voxel
    std::size_t max_bricks; ///< of all partial levels
    double max_bytes;       ///< for building them
};

/// Bytes of a brick of a partial level, including those in its field.
inline constexpr double bytes_per_partial_brick = 6000.0;

/// At most two levels, from finest to coarsest: one of a quarter of the voxel size around the voxels beside walls and
/// gaps thinner than a voxel, and one of half the voxel size within 1.5 voxels of all unresolved voxels. The finer
/// level is left out if both together exceed `max_bricks`, or if the finer one covers too large a box. Both are left
/// out if the coarser level alone exceeds `max_bricks` or covers too large a box, or if building the levels takes more
/// than `max_bytes`. Cost: 20 ns per triangle, plus Band::brick() for each brick.
std::vector<LevelSet> partial_levels(const UnresolvedVoxels& unresolved, const PartialLevelsSource& source);

}
