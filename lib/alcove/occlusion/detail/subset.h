/// Some of many, spread over all of them.
#pragma once

#include "alcove/base/types.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alcove {

/// Up to `most` of the items, evenly.
std::vector<std::uint32_t> evenly(std::span<const std::uint32_t> items, std::size_t most);

/// The surfels of those indices.
std::vector<Surfel> pick(std::span<const Surfel> surfels, std::span<const std::uint32_t> indices);

}
