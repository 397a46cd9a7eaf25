#include "length.h"

#include "common.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace alcove::cli {

Length parse_length(const std::string& text, const std::string& option) {
    const char* begin = text.c_str();
    char* end = nullptr;
    Length length;
    length.value = std::strtod(begin, &end);
    const std::string unit = end;
    if (unit == "%") {
        length.value /= 100.0;
        length.unit = Length::Unit::diagonal;
    } else if (unit == "vx") {
        length.unit = Length::Unit::voxels;
    } else if (!unit.empty()) {
        end = const_cast<char*>(begin);
    }
    if (end == begin || !(length.value > 0.0))
        throw UsageError(
            fmt::format("{} takes a positive length, not '{}': write 0.2 (scene units), 10% (of the "
                        "diagonal) or 3vx (finest voxels)",
                        option, text));
    return length;
}

float Length::to_unit(double diagonal, float voxel) const {
    switch (unit) {
    case Unit::scene:
        return static_cast<float>(value / diagonal);
    case Unit::diagonal:
        return static_cast<float>(value);
    case Unit::voxels:
        break;
    }
    if (voxel <= 0.0f)
        throw UsageError(
            "a length in vx needs the voxel itself to be set: give --voxel as a length or a percentage");
    return static_cast<float>(value * voxel);
}

}
