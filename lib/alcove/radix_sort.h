/// Sorts by integer keys in linear time. Internal.
#pragma once

#include "alcove/huge_pages.h"

#include <cstdint>

namespace alcove {

struct Keyed {
    std::uint64_t key;
    std::uint32_t value;
};

/// Stable, by the bits of the keys from `low` to below `high`, above which all are 0. The work is cut in blocks whose
/// number depends on the count alone, and spread over the threads.
void radix_sort(HugeVector<Keyed>& items, int low, int high);

}
