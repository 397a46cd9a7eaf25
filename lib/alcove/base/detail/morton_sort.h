/// Spatial sorting: Morton codes, which order cells so that neighbours stay close, and a radix sort by such codes.
#pragma once

#include "alcove/base/detail/memory.h"
#include "alcove/base/types.h"

#include <array>
#include <cstdint>

namespace alcove {

/// Bits per coordinate; a code has three times as many bits.
inline constexpr int morton_bits = 21;

/// The Morton code of a cell: the interleaved bits of its coordinates, with x in the higher bits (Morton 1966).
/// \pre coordinates in [0, 2^21)
inline std::uint64_t morton_code(const Vec3d& cell) {
    const auto spread = [](double coordinate) { // inserts two zero bits before each bit
        auto x = static_cast<std::uint64_t>(coordinate);
        x = (x | x << 32) & 0x1f00000000ffff;
        x = (x | x << 16) & 0x1f0000ff0000ff;
        x = (x | x << 8) & 0x100f00f00f00f00f;
        x = (x | x << 4) & 0x10c30c30c30c30c3;
        return (x | x << 2) & 0x1249249249249249;
    };
    return spread(cell.x) << 2 | spread(cell.y) << 1 | spread(cell.z);
}

/// The coordinates z, y and x of the cell that has this code.
/// \pre at most ten bits per coordinate
inline std::array<std::uint16_t, 3> morton_cell(std::uint32_t code) {
    const auto gathered = [](std::uint32_t x) { // inverse of spread()
        x &= 0x9249249;
        x = (x | x >> 2) & 0x30c30c3;
        x = (x | x >> 4) & 0x300f00f;
        x = (x | x >> 8) & 0x30000ff;
        return static_cast<std::uint16_t>((x | x >> 16) & 0x3ff);
    };
    return {gathered(code), gathered(code >> 1), gathered(code >> 2)};
}

template <class Key>
struct Keyed {
    Key key;
    std::uint32_t value;
};

/// Sorts stably by the key bits [low, high); the higher bits must be 0. Multithreaded, in blocks that depend only
/// on the number of items.
template <class Key>
void radix_sort(HugeVector<Keyed<Key>>& items, int low, int high);
extern template void radix_sort(HugeVector<Keyed<std::uint32_t>>&, int, int);
extern template void radix_sort(HugeVector<Keyed<std::uint64_t>>&, int, int);

}
