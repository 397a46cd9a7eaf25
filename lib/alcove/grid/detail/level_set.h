/// OpenVDB level sets of a band. Internal to grid/.
#pragma once

#include "alcove/grid/detail/band.h"

namespace alcove {

/// The level of the given stride: values times `value_scale`, the inside of solids filled. What the level of half
/// the stride has, `finer` if there is one, is taken from there. Sets grid, active_voxels and bytes.
LevelSet level_set(const Band& band, int stride, double value_scale, const LevelSet* finer = nullptr);

}
