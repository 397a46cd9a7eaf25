#include "alcove/base/detail/morton_sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace alcove {
namespace {

template <class Key>
class RadixSort : public testing::Test {};
using KeyTypes = testing::Types<std::uint32_t, std::uint64_t>;
TYPED_TEST_SUITE(RadixSort, KeyTypes);

TYPED_TEST(RadixSort, IsTheStableSort) {
    std::mt19937_64 random(7);
    for (const std::size_t count : {0u, 1u, 2u, 1000u, 200'000u})
        for (const auto& [low, high] : {std::pair{0, 30}, {0, 8}, {3, 20}, {0, 0}}) {
            HugeVector<Keyed<TypeParam>> items(count);
            for (std::uint32_t i = 0; i < count; ++i)
                items[i] = {static_cast<TypeParam>(random() & ((TypeParam{1} << high) - 1)), i};
            auto expected = items;
            std::stable_sort(expected.begin(), expected.end(),
                             [low](const auto& a, const auto& b) { return a.key >> low < b.key >> low; });
            radix_sort(items, low, high);
            for (std::size_t i = 0; i < count; ++i) {
                ASSERT_EQ(items[i].value, expected[i].value) << count << " " << low << " " << high;
                ASSERT_EQ(items[i].key, expected[i].key);
            }
        }
}

}
}
