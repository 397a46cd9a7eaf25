/// OpenVDB level sets of a band. Internal to grid/.
#pragma once

#include "alcove/grid/band.h"

namespace alcove {

/// The level of the given stride: values times `value_scale`, the inside of solids filled. Sets grid,
/// active_voxels and bytes.
LevelSet level_set(const Band& band, int stride, double value_scale);

}
