#include "alcove/base/types.h"

#include <cmath>

namespace alcove {

double Box::diagonal() const {
    if (empty())
        return 0.0;
    // Scale first, so that the squares of huge and tiny extents stay in the range of a double.
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
        throw InputError("coordinates are farther apart than numbers can represent: scale them down");
    if (std::fpclassify(diagonal) == FP_SUBNORMAL)
        throw InputError("coordinates are closer together than numbers can resolve: scale them up");
    frame.center = box.center();
    if (diagonal > 0.0)
        frame.diagonal = diagonal;
    return frame;
}

}
