/// The instruction set that SIMD code runs on.
#pragma once

#include <string>

namespace alcove {

/// The best of those that this processor supports and the code was compiled for, such as "AVX2". Chosen at run time.
std::string simd_target();

}
