#include "alcove/measure/detail/pareto.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace alcove {

std::vector<std::size_t> pareto_front(std::span<const CostAndError> choices) {
    std::vector<std::size_t> order(choices.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::tuple(choices[a].cost, choices[a].error, a) < std::tuple(choices[b].cost, choices[b].error, b);
    });
    double min_error = std::numeric_limits<double>::infinity();
    std::vector<std::size_t> front;
    for (const std::size_t i : order)
        if (choices[i].error < min_error) {
            min_error = choices[i].error;
            front.push_back(i);
        }
    return front;
}

}
