/// Detects walls that are too thin for the voxel size of a grid.
#pragma once

#include "alcove/occlusion/methods/exact.h"

#include <span>

namespace alcove {

struct ThinWalls {
    double share = 0.0; ///< of the surfels with a normal, the share whose next face is too near, in [0, 1]
    /// Voxel size that resolves nine tenths of the walls that are too thin, unit space; 0 if no wall is too thin.
    float voxel = 0.0f;

    bool noticeable() const { return share >= 0.005; } ///< tips and rims alone stay below
};

/// For solids, looks for the far side of a wall within 1.5 voxels behind each surfel. For sheets, looks for any face
/// within 2.5 voxels, behind or in front. Hardly any grid sample is inside such a wall or between such sheets, so rays
/// through the grid miss the faces. Narrow gaps between solids are no problem: rays through the grid stop there.
/// `voxel` is in unit space. Cost: two rays for each of at most 4,096 surfels, evenly spaced along the Morton curve.
ThinWalls thin_walls(std::span<const Surfel> surfels, const RaySurface& surface, float voxel, bool two_sided);

}
