/// Converts the options of a bake to the settings that its targets share.
#pragma once

#include "alcove/bake/detail/target.h"

namespace alcove {

/// \throw InputError if the method, the parameters and the attributes do not fit together.
BakeTask task_of(const BakeOptions& options);

/// The voxelization options for a mesh, in the unit space of its frame. \throw InputError as Length::to_unit()
VoxelizeOptions voxelizing_of(const BakeOptions& options, const Frame& frame);

/// The radius in unit space; may be infinite. \throw InputError as Length::to_unit()
float radius_of(const BakeOptions& options, const Frame& frame, const VoxelizeOptions& voxelizing);

}
