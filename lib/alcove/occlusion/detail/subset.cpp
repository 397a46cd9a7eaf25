#include "alcove/occlusion/detail/subset.h"

#include <algorithm>

namespace alcove {

std::vector<std::uint32_t> evenly(std::span<const std::uint32_t> items, std::size_t max_count) {
    const std::size_t count = std::min(items.size(), max_count);
    std::vector<std::uint32_t> chosen(count);
    for (std::size_t i = 0; i < count; ++i)
        chosen[i] = items[i * items.size() / count];
    return chosen;
}

namespace {

template <class T>
std::vector<T> picked(std::span<const T> items, std::span<const std::uint32_t> indices) {
    std::vector<T> picked;
    picked.reserve(indices.size());
    for (const std::uint32_t i : indices)
        picked.push_back(items[i]);
    return picked;
}

}

std::vector<Surfel> pick(std::span<const Surfel> surfels, std::span<const std::uint32_t> indices) {
    return picked(surfels, indices);
}

std::vector<std::uint32_t> pick(std::span<const std::uint32_t> items, std::span<const std::uint32_t> indices) {
    return picked(items, indices);
}

}
