#include "alcove/base/detail/memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

#ifdef __linux__
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace alcove {

#ifdef __linux__

void prefer_huge_pages(void* begin, std::size_t bytes) {
    constexpr std::size_t page = std::size_t(1) << 21;
    if (std::align(page, page, begin, bytes) != nullptr)
        ::madvise(begin, bytes / page * page, MADV_HUGEPAGE);
}

void keep_freed_memory() {
#ifdef __GLIBC__
    ::mallopt(M_MMAP_MAX, 0); // else large arrays get their own mappings, which free() returns to the system
    ::mallopt(M_TRIM_THRESHOLD, -1);
#endif
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
    std::ofstream("/proc/self/clear_refs") << 5; // 5 resets the peak, see proc(5)
}

double system_memory() {
    const double machine =
        static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
    return std::min(machine, control_group_memory("/proc/self/cgroup", "/sys/fs/cgroup"));
}

#else

void prefer_huge_pages(void*, std::size_t) {}

void keep_freed_memory() {}

std::size_t peak_resident_bytes() {
    return 0;
}

void forget_peak_resident_bytes() {}

double system_memory() {
    return std::numeric_limits<double>::infinity();
}

#endif

double control_group_memory(const std::filesystem::path& membership, const std::filesystem::path& groups) {
    double least = std::numeric_limits<double>::infinity();
    std::ifstream lines(membership);
    for (std::string line; std::getline(lines, line);) {
        constexpr std::string_view version_2 = "0::/";
        if (!line.starts_with(version_2))
            continue;
        std::filesystem::path group = line.substr(version_2.size());
        for (bool outermost = false; !outermost; group = group.parent_path()) {
            outermost = group.empty();
            if (double bytes = 0.0; std::ifstream(groups / group / "memory.max") >> bytes) // fails for "max": no limit
                least = std::min(least, bytes);
        }
    }
    return least;
}

}
