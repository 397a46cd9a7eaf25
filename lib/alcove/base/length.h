/// Lengths as people write them: `0.2` scene units, `10%` of the diagonal, `3vx` finest voxels, `inf`.
#pragma once

#include <string>

namespace alcove {

struct Length {
    enum class Unit { scene, diagonal, voxels };
    double value = 0.0;
    Unit unit = Unit::scene;

    /// In unit space, where the diagonal is 1. \throw InputError for voxels where `voxel` (unit space) is 0,
    /// and for lengths that nothing of that diagonal can be meant to have.
    float to_unit(double diagonal, float voxel = 0.0f) const;
};

/// \throw InputError "takes a positive length, not ..." if the text is none.
Length parse_length(const std::string& text);

}
