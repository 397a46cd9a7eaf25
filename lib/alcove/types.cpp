#include "alcove/types.h"

#include <cmath>

namespace alcove {

double Box::diagonal() const {
    if (empty())
        return 0.0;
    // Scaled so that neither the squares of huge extents nor those of tiny ones leave the range of a double.
    const Vec3d extent = max - min;
    const double largest = std::fmax(extent.x, std::fmax(extent.y, extent.z));
    return largest > 0.0 ? largest * glm::length(extent / largest) : 0.0;
}

Frame frame_of(const Box& box) {
    Frame frame;
    if (box.empty())
        return frame;
    frame.center = box.center();
    if (const double d = box.diagonal(); d > 0.0)
        frame.diagonal = d;
    return frame;
}

}
