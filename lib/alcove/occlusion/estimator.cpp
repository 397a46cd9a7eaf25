#include "alcove/occlusion/estimator.h"

#include "alcove/base/detail/morton_sort.h"

#include <algorithm>
#include <tuple>

namespace alcove {

std::vector<std::uint32_t> spatial_order(std::span<const Surfel> surfels) {
    Box box;
    for (const Surfel& s : surfels)
        if (s.has_normal())
            box.add(Vec3d(s.position));
    using Code = Keyed<std::uint64_t>;
    HugeVector<Code> keys;
    keys.reserve(surfels.size());
    constexpr double cells = 1 << (morton_bits - 1);
    const Vec3d scale = cells / glm::max(box.max - box.min, Vec3d(1e-300));
    for (std::uint32_t i = 0; i < surfels.size(); ++i)
        if (surfels[i].has_normal())
            keys.push_back({morton_code((Vec3d(surfels[i].position) - box.min) * scale), i});
    // Few surfels share even the upper half of their codes, so radix sort covers only those bits. Ties are broken
    // by position and normal, because the result must not depend on the order of the surfels.
    constexpr int code_bits = 3 * morton_bits, sorted_by_radix = 33;
    radix_sort(keys, code_bits - sorted_by_radix, code_bits);
    const auto tuple = [&](const Code& key) {
        const Surfel& s = surfels[key.value];
        return std::tuple(s.position.x, s.position.y, s.position.z, s.normal.x, s.normal.y, s.normal.z, s.away.x,
                          s.away.y, s.away.z, key.value);
    };
    const auto upper = [&](const Code& key) { return key.key >> (code_bits - sorted_by_radix); };
    for (auto begin = keys.begin(), end = begin; begin != keys.end(); begin = end) {
        end = std::find_if(begin, keys.end(), [&](const Code& key) { return upper(key) != upper(*begin); });
        std::sort(begin, end,
                  [&](const Code& a, const Code& b) { return a.key != b.key ? a.key < b.key : tuple(a) < tuple(b); });
    }
    std::vector<std::uint32_t> order(keys.size());
    std::transform(keys.begin(), keys.end(), order.begin(), [](const Code& k) { return k.value; });
    return order;
}

}
