/// Finds likely causes of a large error of a bake, and how to fix them.
#pragma once

#include "alcove/bake/detail/target.h"

namespace alcove {

/// Warnings about an RMSE that the pilot measured. If it is above 0.03 and rays were traced through the grid, walls
/// that are too thin for the grid cause a warning. If it is above 0.1 and there is no such warning, a warning names the
/// most likely cause: thin walls, or vertices that touch other faces. If neither is the cause, the warning gives advice
/// on the settings, unless there was an error to meet. Cost: a few rays for each of up to 4,096 surfels.
std::vector<std::string> causes_of(double rmse, const BakeTarget& target, const BakeTask& task, const Method& method,
                                   const Occluders& occluders);

/// A warning if faces are much larger than the radius and interpolating ao between their vertices is inaccurate; else
/// empty. `ao` has one value per vertex. Cost: up to 1,024 × 64 rays.
std::string coarse_faces_warning(const BakeTarget& target, std::span<const float> ao, const RaySurface& rays);

}
