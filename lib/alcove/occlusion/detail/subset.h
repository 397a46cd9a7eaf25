/// Evenly spread subsets.
#pragma once

#include "alcove/base/types.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alcove {

/// At most `max_count` of the items, at even steps.
std::vector<std::uint32_t> evenly(std::span<const std::uint32_t> items, std::size_t max_count);

/// items[i] for each index i.
std::vector<std::uint32_t> pick(std::span<const std::uint32_t> items, std::span<const std::uint32_t> indices);
std::vector<Surfel> pick(std::span<const Surfel> surfels, std::span<const std::uint32_t> indices);

}
