#include "alcove/huge_pages.h"

#include <sys/mman.h>

#include <memory>

namespace alcove {

void prefer_huge_pages(void* begin, std::size_t bytes) {
    constexpr std::size_t page = std::size_t(1) << 21;
    if (std::align(page, page, begin, bytes) != nullptr)
        ::madvise(begin, bytes / page * page, MADV_HUGEPAGE);
}

}
