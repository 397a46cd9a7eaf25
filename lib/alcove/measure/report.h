/// HTML reports of measurements.
#pragma once

#include "alcove/measure/measure.h"

#include <span>
#include <string>

namespace alcove {

/// A complete HTML page that needs no other file and no network. For every mesh and radius it has a chart of error
/// against CPU seconds with the Pareto front, a table sorted by error (a click on a heading sorts by that column), and
/// the error images. If there are several voxels or radii, charts of error against them are added; if there are several
/// meshes, charts of all meshes combined.
std::string report(std::span<const Measurement> measurements);

/// A chart of error against CPU seconds with the Pareto front, as an <svg> element.
std::string chart_of_times(std::span<const Measurement> measurements);

}
