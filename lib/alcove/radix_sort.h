/// Sorts by integer keys in linear time. Internal.
#pragma once

#include "alcove/huge_pages.h"

#include <cstdint>

namespace alcove {

template <class Key>
struct Keyed {
    Key key;
    std::uint32_t value;
};

/// Stable, by the bits of the keys from `low` to below `high`, above which all are 0. The work is cut in blocks whose
/// number depends on the count alone, and spread over the threads.
template <class Key>
void radix_sort(HugeVector<Keyed<Key>>& items, int low, int high);
extern template void radix_sort(HugeVector<Keyed<std::uint32_t>>&, int, int);
extern template void radix_sort(HugeVector<Keyed<std::uint64_t>>&, int, int);

}
