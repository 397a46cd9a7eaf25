/// Which of several choices are worth their cost.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace alcove {

struct CostAndError {
    double cost = 0.0, error = 0.0;
};

/// The indices of the choices that no other beats, cheapest first: every cheaper or as cheap one has a larger
/// error. Of equal ones the first. V. Pareto, "Manuale di economia politica" (1906). Cost: n log n.
std::vector<std::size_t> pareto_front(std::span<const CostAndError> choices);

}
