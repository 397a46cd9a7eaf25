#include "alcove/base/detail/limits.h"

#include "alcove/base/detail/memory.h"

#include <algorithm>
#include <atomic>

namespace alcove {
namespace {

// In bytes; 0 stands for the default.
std::atomic<double> memory{0.0}, reading{0.0};

}

double memory_limit() {
    static const double half_of_memory = 0.5 * system_memory();
    return memory > 0.0 ? memory.load() : half_of_memory;
}

void limit_memory(double bytes) {
    memory = bytes;
}

double read_limit() {
    constexpr double most = 4e9;
    return reading > 0.0 ? reading.load() : std::min(0.5 * memory_limit(), most);
}

void limit_reading(double bytes) {
    reading = bytes;
}

}
