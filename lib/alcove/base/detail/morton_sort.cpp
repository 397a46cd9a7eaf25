#include "alcove/base/detail/morton_sort.h"

#include "alcove/base/parallel.h"

#include <algorithm>
#include <array>

namespace alcove {

template <class Key>
void radix_sort(HugeVector<Keyed<Key>>& items, int low, int high) {
    constexpr int max_digit_bits = 11; // so that a histogram fits in the L1 cache
    constexpr std::size_t min_block = 1 << 14, max_blocks = 16;
    using Histogram = std::array<std::uint32_t, 1 << max_digit_bits>;
    const int bits = high - low, passes = (bits + max_digit_bits - 1) / max_digit_bits;
    const int digit_bits = passes > 0 ? (bits + passes - 1) / passes : 0;
    const std::size_t digits = std::size_t{1} << digit_bits;
    const std::size_t grain = std::max(min_block, (items.size() + max_blocks - 1) / max_blocks);
    std::vector<Histogram> blocks((items.size() + grain - 1) / grain);
    HugeVector<Keyed<Key>> other(items.size());
    for (int pass = 0; pass < passes; ++pass) {
        const auto digit = [&](const Keyed<Key>& item) { return item.key >> (low + pass * digit_bits) & (digits - 1); };
        parallel_for(items.size(), grain, [&](std::size_t begin, std::size_t end) {
            Histogram& count = blocks[begin / grain];
            count.fill(0);
            for (std::size_t i = begin; i < end; ++i)
                ++count[digit(items[i])];
        });
        std::uint32_t at = 0;
        for (std::size_t d = 0; d < digits; ++d)
            for (Histogram& block : blocks) {
                const std::uint32_t count = block[d];
                block[d] = at;
                at += count;
            }
        parallel_for(items.size(), grain, [&](std::size_t begin, std::size_t end) {
            Histogram& next = blocks[begin / grain];
            for (std::size_t i = begin; i < end; ++i)
                other[next[digit(items[i])]++] = items[i];
        });
        items.swap(other);
    }
}

template void radix_sort(HugeVector<Keyed<std::uint32_t>>&, int, int);
template void radix_sort(HugeVector<Keyed<std::uint64_t>>&, int, int);

}
