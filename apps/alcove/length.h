/// Lengths on the command line.
#pragma once

#include "alcove/base/length.h"

#include <string>

namespace alcove::cli {

/// As alcove::parse_length(). \throw UsageError naming `option` where that throws.
Length parse_length(const std::string& text, const std::string& option);

/// As Length::to_unit(). \throw UsageError where that throws.
float to_unit(const Length& length, double diagonal, float voxel = 0.0f);

}
