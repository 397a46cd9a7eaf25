#include "alcove/base/detail/memory.h"

#include <fstream>
#include <memory>
#include <string>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace alcove {

#ifdef __linux__

void prefer_huge_pages(void* begin, std::size_t bytes) {
    constexpr std::size_t page = std::size_t(1) << 21;
    if (std::align(page, page, begin, bytes) != nullptr)
        ::madvise(begin, bytes / page * page, MADV_HUGEPAGE);
}

std::size_t peak_resident_bytes() {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (word == "VmHWM:") {
            std::size_t kibibytes = 0;
            status >> kibibytes;
            return kibibytes * 1024;
        }
    return 0;
}

void forget_peak_resident_bytes() {
    std::ofstream("/proc/self/clear_refs") << 5; // proc(5)
}

#else

void prefer_huge_pages(void*, std::size_t) {}

std::size_t peak_resident_bytes() {
    return 0;
}

void forget_peak_resident_bytes() {}

#endif

}
