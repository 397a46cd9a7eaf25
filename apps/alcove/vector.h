/// Points and directions as people write them: `1,2.5,-3`.
#pragma once

#include "alcove/base/types.h"

#include <string>

namespace alcove::cli {

/// \throw UsageError naming `option` if the text is not three finite numbers.
Vec3d parse_vector(const std::string& text, const std::string& option);

/// Of any length but 0. \throw UsageError as parse_vector(), and for 0,0,0.
Vec3d parse_direction(const std::string& text, const std::string& option);

}
