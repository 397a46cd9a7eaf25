#include "alcove/mesh/detail/number_set.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

using namespace alcove;

TEST(NumberSet, AgreesWithAnOrderedSet) {
    std::mt19937 random(1);
    NumberSet numbers;
    for (const std::size_t limit : {1u, 63u, 64u, 65u, 4096u, 4097u, 300000u}) {
        numbers.reset(limit);
        EXPECT_TRUE(numbers.empty());
        std::set<std::size_t> expected;
        for (int round = 0; round < 3000; ++round) {
            const std::size_t number = random() % limit;
            if (random() % 2 == 0) {
                numbers.insert(number);
                expected.insert(number);
            } else {
                const std::size_t member = expected.empty() ? number : *expected.begin();
                numbers.remove(member);
                expected.erase(member);
            }
            ASSERT_EQ(numbers.empty(), expected.empty());
            if (expected.empty())
                continue;
            const auto next = expected.lower_bound(number);
            ASSERT_EQ(numbers.next_or_first(number), next == expected.end() ? *expected.begin() : *next);
        }
    }
}
