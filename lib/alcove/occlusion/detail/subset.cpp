#include "alcove/occlusion/detail/subset.h"

#include <algorithm>
#include <array>

namespace alcove {

bool is_same(const Surfel& a, const Surfel& b) {
    return a.position == b.position && a.normal == b.normal && a.away == b.away && a.covered == b.covered &&
           a.highest == b.highest;
}

float median_spacing(std::span<const Surfel> curve, std::size_t i) {
    constexpr std::size_t half = 4;
    std::array<float, 2 * half> distances;
    std::size_t count = 0;
    for (std::size_t k = i - std::min(i, half); k < std::min(i + half + 1, curve.size()); ++k)
        if (k != i)
            distances[count++] = glm::length(curve[k].position - curve[i].position);
    if (count == 0)
        return 0.0f;
    // A partial sort up to the median. It is free of branches, because the processor would mispredict them.
    for (std::size_t sorted = 0; sorted <= count / 2; ++sorted)
        for (std::size_t k = count - 1; k > sorted; --k) {
            const float a = distances[k - 1], b = distances[k];
            distances[k - 1] = std::min(a, b);
            distances[k] = std::max(a, b);
        }
    return distances[count / 2];
}

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
