#include "vector.h"

#include "common.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace alcove::cli {

Vec3d parse_vector(const std::string& text, const std::string& option) {
    Vec3d v;
    const char* at = text.c_str();
    for (int axis = 0; axis < 3; ++axis) {
        char* end = nullptr;
        v[axis] = std::strtod(at, &end);
        const bool last = axis == 2;
        if (end == at || !std::isfinite(v[axis]) || *end != (last ? '\0' : ','))
            throw UsageError(
                fmt::format("{} takes three numbers, not '{}': write {} 1,2.5,-3", option, text, option));
        at = end + 1;
    }
    return v;
}

Vec3d parse_direction(const std::string& text, const std::string& option) {
    const Vec3d v = parse_vector(text, option);
    if (v == Vec3d(0.0))
        throw UsageError(
            fmt::format("{0} takes a direction, not 0,0,0: write {0} 0,1,0 or {0} 0,0,1", option));
    return v;
}

}
