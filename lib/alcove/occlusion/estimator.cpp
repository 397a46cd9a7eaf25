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
    constexpr double cells = 1 << (morton_bits - 1);
    const Vec3d scale = cells / glm::max(box.max - box.min, Vec3d(1e-300));
    const auto code = [&](std::uint32_t i) { return morton_code((Vec3d(surfels[i].position) - box.min) * scale); };
    // Few surfels share the upper 32 bits of their codes, so the radix sort covers only these bits. Ties are broken by
    // the whole code, then by position, normal and `away`, because the result must not depend on the order of the
    // surfels.
    constexpr int code_bits = 3 * morton_bits, sorted_by_radix = 32;
    using Key = Keyed<std::uint32_t>;
    HugeVector<Key> keys;
    keys.reserve(surfels.size());
    for (std::uint32_t i = 0; i < surfels.size(); ++i)
        if (surfels[i].has_normal())
            keys.push_back({static_cast<std::uint32_t>(code(i) >> (code_bits - sorted_by_radix)), i});
    radix_sort(keys, 0, sorted_by_radix);
    const auto tuple = [&](std::uint32_t i) {
        const Surfel& s = surfels[i];
        return std::tuple(s.position.x, s.position.y, s.position.z, s.normal.x, s.normal.y, s.normal.z, s.away.x,
                          s.away.y, s.away.z, i);
    };
    std::vector<Keyed<std::uint64_t>> ties;
    constexpr std::size_t ahead = 32;
    for (std::size_t begin = 0, end = 0; begin != keys.size(); begin = end) {
        for (++end; end != keys.size() && keys[end].key == keys[begin].key;)
            ++end;
        for (std::size_t i = begin + ahead; i < std::min(end + ahead, keys.size()); ++i)
            __builtin_prefetch(&surfels[keys[i].value]);
        if (end - begin == 1)
            continue;
        ties.clear();
        for (std::size_t i = begin; i < end; ++i)
            ties.push_back({code(keys[i].value), keys[i].value});
        std::sort(ties.begin(), ties.end(), [&](const auto& x, const auto& y) {
            return x.key != y.key ? x.key < y.key : tuple(x.value) < tuple(y.value);
        });
        for (std::size_t i = begin; i < end; ++i)
            keys[i].value = ties[i - begin].value;
    }
    std::vector<std::uint32_t> order(keys.size());
    std::transform(keys.begin(), keys.end(), order.begin(), [](const Key& k) { return k.value; });
    return order;
}

}
