/// Pareto front of cost and error.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace alcove {

struct CostAndError {
    double cost = 0.0, error = 0.0;
};

/// The indices of the Pareto-optimal choices, cheapest first: those for which every other choice of at most the same
/// cost has a larger error (Pareto 1906). Of equal choices, only the first is included. Cost: n log n.
std::vector<std::size_t> pareto_front(std::span<const CostAndError> choices);

}
