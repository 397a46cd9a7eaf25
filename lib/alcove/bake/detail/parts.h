/// Bakes each connected part of a mesh as if it were alone.
#pragma once

#include "alcove/bake/detail/target.h"

namespace alcove {

/// Each part is a target in its own unit space. The voxel of a part is the requested one, but at most 1/32 of the
/// part's diagonal; if none is requested, it is the voxel that a bake of the part alone would choose. The result is for
/// the whole mesh: the grid summary has the largest voxel and the largest numbers of levels and bytes, and the RMSE is
/// that over all surfels. \throw like bake()
TargetResult bake_parts(const BakeTarget& whole, const BakeTask& task, NormalSource normals, Surroundings& surroundings,
                        const BakeProgress& progress);

}
