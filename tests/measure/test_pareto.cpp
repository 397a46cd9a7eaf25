#include "alcove/measure/detail/pareto.h"

#include <gtest/gtest.h>

namespace alcove {
namespace {

using Indices = std::vector<std::size_t>;

TEST(ParetoFront, KeepsWhatNothingCheaperBeats) {
    const std::vector<CostAndError> choices{{4.0, 0.1}, {1.0, 0.5}, {2.0, 0.6}, {3.0, 0.2},
                                            {3.0, 0.3}, {5.0, 0.1}, {9.0, 0.05}};
    EXPECT_EQ(pareto_front(choices), (Indices{1, 3, 0, 6}));
}

TEST(ParetoFront, TakesTheFirstOfEquals) {
    EXPECT_EQ(pareto_front(std::vector<CostAndError>{{1.0, 0.5}, {1.0, 0.5}}), Indices{0});
    EXPECT_EQ(pareto_front(std::vector<CostAndError>{{1.0, 0.5}, {1.0, 0.4}}), Indices{1});
    EXPECT_TRUE(pareto_front({}).empty());
}

}
}
