#include "alcove/mesh/detail/weld.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/parallel.h"
#include "alcove/mesh/mesh.h"

#include <bit>

namespace alcove {
namespace {

std::uint64_t mix(std::uint64_t x) { // finalizer of MurmurHash3 (Appleby 2011)
    x = (x ^ (x >> 33)) * 0xff51afd7ed558ccdULL;
    x = (x ^ (x >> 33)) * 0xc4ceb9fe1a85ec53ULL;
    return x ^ (x >> 33);
}

std::uint64_t hash(const Vec3d& p) {
    // Adding zero turns -0 into 0.
    const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value + 0.0); };
    return mix(bits(p.x) + mix(bits(p.y) + mix(bits(p.z) + 1)));
}

/// Stores half of the hash of the position, which saves most comparisons of positions.
struct Slot {
    std::uint32_t hash = 0;
    std::uint32_t vertex = UINT32_MAX;
};

}

std::vector<std::uint32_t> weld(std::span<const Vec3d> positions) {
    const std::size_t count = positions.size();
    std::vector<std::uint64_t> hashes = huge_vector<std::uint64_t>(count);
    parallel_for(count, 1 << 15, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v)
            hashes[v] = hash(positions[v]);
    });

    const std::size_t mask = std::bit_ceil(2 * count + 1) - 1;
    std::vector<Slot> table = huge_vector<Slot>(mask + 1);
    std::vector<std::uint32_t> first = huge_vector<std::uint32_t>(count);
    for (std::uint32_t v = 0; v < count; ++v) {
        const Vec3d& p = positions[v];
        first[v] = v;
        if (p != p)
            continue;
        const auto part = static_cast<std::uint32_t>(hashes[v] >> 32);
        std::size_t at = hashes[v] & mask;
        while (table[at].vertex != UINT32_MAX && (table[at].hash != part || positions[table[at].vertex] != p))
            at = (at + 1) & mask;
        if (table[at].vertex == UINT32_MAX)
            table[at] = {part, v};
        else
            first[v] = table[at].vertex;
    }
    return first;
}

std::vector<std::uint32_t> weld(std::span<const Vec3d> positions, double distance) {
    Box box;
    for (const Vec3d& p : positions)
        if (is_finite(p))
            box.add(p);
    constexpr std::uint32_t none = UINT32_MAX;
    const std::size_t mask = std::bit_ceil(positions.size() + 1) - 1;
    std::vector<std::uint32_t> newest(mask + 1, none), older(positions.size(), none); // linked lists, one per hash
    std::vector<std::uint32_t> first(positions.size());
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        first[v] = v;
        if (!is_finite(positions[v]))
            continue;
        // If the edge of a cell is twice the radius of a ball, the ball meets at most 2 × 2 × 2 cells.
        const Vec3d place = (positions[v] - box.min) / (2.0 * distance), low = glm::floor(place - 0.5);
        double nearest = distance;
        for (int corner = 0; corner < 8; ++corner)
            for (std::uint32_t u = newest[hash(low + Vec3d(corner & 1, corner >> 1 & 1, corner >> 2)) & mask];
                 u != none; u = older[u])
                if (const double apart = glm::distance(positions[u], positions[v]);
                    apart < nearest || (apart == nearest && (first[v] == v || u < first[v]))) {
                    nearest = apart;
                    first[v] = u;
                }
        if (first[v] == v) {
            std::uint32_t& list = newest[hash(glm::floor(place)) & mask];
            older[v] = list;
            list = v;
        }
    }
    return first;
}

}
