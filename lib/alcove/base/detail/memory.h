/// Memory of the process: large arrays on pages of 2 MB, and how much is resident. The system takes longer to hand out a
/// page than the page takes to fill, and a mesh of a million triangles lies on tens of thousands of small ones.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
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

/// Memory on huge pages; values that are given none are left as they are, to be touched first by the thread that
/// writes them.
template <class T>
struct HugeAllocator : std::allocator<T> {
    template <class U>
    struct rebind {
        using other = HugeAllocator<U>;
    };
    T* allocate(std::size_t count) {
        T* values = std::allocator<T>::allocate(count);
        prefer_huge_pages(values, count * sizeof(T));
        return values;
    }
    template <class U, class... Arguments>
    void construct(U* at, Arguments&&... arguments) {
        if constexpr (sizeof...(Arguments) == 0)
            ::new (static_cast<void*>(at)) U;
        else
            ::new (static_cast<void*>(at)) U(std::forward<Arguments>(arguments)...);
    }
};

/// For what is written as it grows, or in full after it got its size.
template <class T>
using HugeVector = std::vector<T, HugeAllocator<T>>;

/// A vector of `count` equal values, on huge pages.
template <class T>
std::vector<T> huge_vector(std::size_t count, const T& value = {}) {
    std::vector<T> values;
    reserve_huge(values, count);
    values.resize(count, value);
    return values;
}

/// The most bytes that were resident at once since the program began or the peak was forgotten; 0 where the system does
/// not tell. Not of the program that started this one, which getrusage() counts in.
std::size_t peak_resident_bytes();

/// From now on the peak is that of what follows.
void forget_peak_resident_bytes();

}
