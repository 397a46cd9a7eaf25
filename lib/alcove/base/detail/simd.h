/// The instruction set that SIMD code runs on.
#pragma once

#include <string>

namespace alcove {

/// The name of the instruction set, such as "AVX2". At run time, the best set is chosen that the processor supports and
/// for which the code was compiled.
std::string simd_target();

}
