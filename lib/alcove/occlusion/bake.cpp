#include "alcove/occlusion/bake.h"

#include <algorithm>
#include <tuple>

namespace alcove {
namespace {

/// Every third bit of the result, from the lowest 21 of x.
std::uint64_t spread(std::uint64_t x) {
    x &= 0x1fffff;
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    x = (x | x << 2) & 0x1249249249249249;
    return x;
}

}

std::vector<std::uint32_t> spatial_order(std::span<const Surfel> surfels) {
    Box box;
    for (const Surfel& s : surfels)
        if (s.has_normal())
            box.add(Vec3d(s.position));
    struct Key {
        std::uint64_t code;
        std::uint32_t index;
    };
    std::vector<Key> keys;
    keys.reserve(surfels.size());
    constexpr double cells = 1 << 20;
    const Vec3d scale = cells / glm::max(box.max - box.min, Vec3d(1e-300));
    for (std::uint32_t i = 0; i < surfels.size(); ++i)
        if (surfels[i].has_normal()) {
            const Vec3d cell = (Vec3d(surfels[i].position) - box.min) * scale;
            const auto code = [](double x) { return spread(static_cast<std::uint64_t>(x)); };
            keys.push_back({code(cell.x) << 2 | code(cell.y) << 1 | code(cell.z), i});
        }
    // Within a cell, by what the surfels are: their order in the list may not matter.
    const auto tuple = [&](const Key& key) {
        const Surfel& s = surfels[key.index];
        return std::tuple(s.position.x, s.position.y, s.position.z, s.normal.x, s.normal.y, s.normal.z,
                          key.index);
    };
    std::sort(keys.begin(), keys.end(), [&](const Key& a, const Key& b) {
        return a.code != b.code ? a.code < b.code : tuple(a) < tuple(b);
    });
    std::vector<std::uint32_t> order(keys.size());
    std::transform(keys.begin(), keys.end(), order.begin(), [](const Key& k) { return k.index; });
    return order;
}

}
