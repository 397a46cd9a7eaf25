/// Large arrays on pages of 2 MB. The system takes longer to hand out a page than the page takes to be filled,
/// and a mesh of a million triangles lies on tens of thousands of small ones.
#pragma once

#include <cstddef>
#include <vector>

namespace alcove {

/// Asks for huge pages where they fit into [begin, begin + bytes); a hint, without effect where there are
/// none.
void prefer_huge_pages(void* begin, std::size_t bytes);

/// Reserves room for `count` values, on huge pages.
template <class T>
void reserve_huge(std::vector<T>& values, std::size_t count) {
    values.reserve(count);
    prefer_huge_pages(values.data(), values.capacity() * sizeof(T));
}

/// A vector of `count` equal values, on huge pages.
template <class T>
std::vector<T> huge_vector(std::size_t count, const T& value = {}) {
    std::vector<T> values;
    reserve_huge(values, count);
    values.resize(count, value);
    return values;
}

}
