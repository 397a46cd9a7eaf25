#include "alcove/base/detail/simd.h"

#include <hwy/highway.h>

namespace alcove {

std::string simd_target() {
    const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
    return hwy::TargetName(supported & -supported); // Highway gives better targets lower bits
}

}
