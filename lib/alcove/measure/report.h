/// Measurements as a page to look at.
#pragma once

#include "alcove/measure/measure.h"

#include <span>
#include <string>

namespace alcove {

/// A whole HTML page that needs no other file and no network. Of every mesh and radius: error against CPU
/// seconds with the Pareto front, a table sorted by error (a click on a heading sorts by that column), and the
/// pictures; of several voxels or radii, error against them; of several meshes, all of them together.
std::string report(std::span<const Measurement> measurements);

/// Error against CPU seconds with the Pareto front, as an <svg> element.
std::string chart_of_times(std::span<const Measurement> measurements);

}
