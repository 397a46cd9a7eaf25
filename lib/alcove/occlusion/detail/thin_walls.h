/// Walls that a grid is too coarse to tell.
#pragma once

#include "alcove/occlusion/methods/exact.h"

#include <span>

namespace alcove {

struct ThinWalls {
    double share = 0.0; ///< of the surfels with a normal: how many have another face too near
    /// Nine of ten of those walls are told by a grid that fine, unit space; 0 where there are none.
    float voxel = 0.0f;

    bool noticeable() const { return share >= 0.005; } ///< not only tips and rims
};

/// Looks for the far sides of walls within one and a half voxels behind surfels, and for any face of sheets within two
/// and a half, in front of them too. Hardly a sample of the grid is within such a wall, or between such faces of sheets, and
/// rays through the grid pass them; gaps between solids, however narrow, stop rays. `voxel` in unit space. Cost: two rays
/// for each of up to 4,096 surfels, evenly along the Morton curve.
ThinWalls thin_walls(std::span<const Surfel> surfels, const RaySurface& surface, float voxel, bool two_sided);

}
