/// Lengths as people write them: `0.2` scene units, `10%` of the diagonal, `3vx` finest voxels, `inf`.
#pragma once

#include <string>

namespace alcove::cli {

struct Length {
    enum class Unit { scene, diagonal, voxels };
    double value = 0.0;
    Unit unit = Unit::scene;

    /// In unit space, where the diagonal is 1. \throw UsageError for voxels where `voxel` (unit space) is 0,
    /// and for lengths that no mesh of that diagonal can be meant to have.
    float to_unit(double diagonal, float voxel = 0.0f) const;
};

/// \throw UsageError naming `option` if the text is no positive length.
Length parse_length(const std::string& text, const std::string& option);

}
