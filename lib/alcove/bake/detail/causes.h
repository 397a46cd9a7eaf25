/// Finds likely causes of a large error of a bake, and their fixes.
#pragma once

#include "alcove/bake/detail/target.h"

namespace alcove {

/// Warnings about an RMSE that the pilot measured. Above 0.03, there is one if walls are too thin for a grid that rays
/// were traced through. Above 0.1, if there was none, it names the most likely cause: thin walls, or vertices that
/// touch other faces. If the cause is neither, it gives advice on the settings, unless there was an error to meet.
/// Cost: a few rays for each of up to 4,096 surfels.
std::vector<std::string> causes_of(double rmse, const BakeTarget& target, const BakeTask& task, const Method& method,
                                   const Occluders& occluders);

/// A warning if faces are much larger than the radius and interpolating ao between their vertices is inaccurate; else
/// empty. `ao`: one value per vertex. Cost: up to 1,024 × 64 rays.
std::string coarse_faces_warning(const BakeTarget& target, std::span<const float> ao, const RaySurface& rays);

}
