#include "alcove/base/types.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace alcove {

Length::Length(const std::string& text) {
    const char* begin = text.c_str();
    char* end = nullptr;
    value = std::strtod(begin, &end);
    const std::string suffix = end;
    if (suffix == "%") {
        value /= 100.0;
        unit = Unit::diagonal;
    } else if (suffix == "vx") {
        unit = Unit::voxels;
    } else if (!suffix.empty()) {
        end = const_cast<char*>(begin);
    }
    if (end == begin || !(value > 0.0))
        throw InputError(
            fmt::format("takes a positive length, not '{}': write 0.2 (scene units), 10% (of the diagonal), "
                        "3vx (finest voxels) or inf",
                        text));
}

float Length::to_unit(double diagonal, float voxel) const {
    if (unit == Unit::voxels && voxel <= 0.0f)
        throw InputError("a length in vx needs a voxel of known size: set the voxel of a mesh as a length or "
                         "a percentage");
    const double length = unit == Unit::scene ? value / diagonal : unit == Unit::diagonal ? value : value * voxel;
    if (length < 1e-12 || (length > 1e6 && std::isfinite(length)))
        throw InputError(fmt::format("a length of {:.3g} is {:.3g} times the diagonal ({:.3g}): write it in "
                                     "scene units, or as a percentage of the diagonal",
                                     length * diagonal, length, diagonal));
    return static_cast<float>(length);
}

}
