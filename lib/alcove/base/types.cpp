#include "alcove/base/types.h"

#include "alcove/base/errors.h"

#include <cmath>

namespace alcove {

double Box::diagonal() const {
    if (empty())
        return 0.0;
    // Scaled so that neither the squares of huge extents nor those of tiny ones leave the range of a double.
    const Vec3d extent = max - min;
    const double largest = std::fmax(extent.x, std::fmax(extent.y, extent.z));
    return largest > 0.0 && std::isfinite(largest) ? largest * glm::length(extent / largest) : largest;
}

Frame frame_of(const Box& box) {
    Frame frame;
    if (box.empty())
        return frame;
    const double diagonal = box.diagonal();
    if (std::isinf(diagonal))
        throw InputError("coordinates lie further apart than numbers reach: scale them down");
    if (std::fpclassify(diagonal) == FP_SUBNORMAL)
        throw InputError("coordinates lie nearer together than numbers tell: scale them up");
    frame.center = box.center();
    if (diagonal > 0.0)
        frame.diagonal = diagonal;
    return frame;
}

}
