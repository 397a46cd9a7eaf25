/// The instruction set that SIMD code runs on.
#pragma once

#include <string>

namespace alcove {

/// The name of the instruction set, such as "AVX2". At run time, SIMD code uses the best instruction set for which it
/// was compiled and which the processor supports.
std::string simd_target();

}
