/// Builds OpenVDB level sets from a band.
#pragma once

#include "alcove/grid/detail/band.h"

namespace alcove {

/// The level of the given stride, with values multiplied by `value_scale` and the inside of solids filled. Its indices
/// are those of the band plus `first` / stride, a multiple of brick_size. Reuses the distances of `finer`, the level of
/// half the stride, if given. Sets only grid, active_voxels and bytes.
LevelSet level_set(const Band& band, int stride, double value_scale, const Index3& first = Index3(0),
                   const LevelSet* finer = nullptr);

}
