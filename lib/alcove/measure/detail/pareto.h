/// Pareto front of cost and error.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace alcove {

struct CostAndError {
    double cost = 0.0, error = 0.0;
};

/// The indices of the Pareto-optimal choices, cheapest first: every other choice that is not more expensive has a
/// larger error. Equal choices are represented by the first of them (Pareto 1906). Cost: n log n.
std::vector<std::size_t> pareto_front(std::span<const CostAndError> choices);

}
