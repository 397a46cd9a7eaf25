/// Surfels along a curve and subsets of them.
#pragma once

#include "alcove/base/types.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alcove {

/// Whether two surfels agree in everything that an estimator reads, and so get the same values.
bool is_same(const Surfel& a, const Surfel& b);

/// The median distance from surfel `i` to the four before and the four after it along a curve; 0 if it is the only one.
float median_spacing(std::span<const Surfel> curve, std::size_t i);

/// At most `max_count` of the items, evenly spaced.
std::vector<std::uint32_t> evenly(std::span<const std::uint32_t> items, std::size_t max_count);

/// items[i] for each index i.
std::vector<std::uint32_t> pick(std::span<const std::uint32_t> items, std::span<const std::uint32_t> indices);
std::vector<Surfel> pick(std::span<const Surfel> surfels, std::span<const std::uint32_t> indices);

}
