/// Allocates large arrays on pages of 2 MB, and measures the memory of the process and of the machine. Large pages save
/// time: the system takes longer to allocate a page than a program to fill it, and a mesh of a million triangles
/// occupies tens of thousands of small pages.
#pragma once

#include "alcove/base/types.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <new>
#include <span>
#include <utility>
#include <vector>

namespace alcove {

/// Requests huge pages where they fit into [begin, begin + bytes). This is a hint; it has no effect on systems without
/// huge pages.
void prefer_huge_pages(void* begin, std::size_t bytes);

/// Keeps freed memory in the process from now on. Otherwise the system clears each page again before a later array gets
/// it, which takes a tenth of the time of a bake. Only programs should call this, not libraries. Has no effect without
/// glibc.
void keep_freed_memory();

/// Reserves room for `count` values, on huge pages.
template <class T>
void reserve_huge(std::vector<T>& values, std::size_t count) {
    values.reserve(count);
    prefer_huge_pages(values.data(), values.capacity() * sizeof(T));
}

/// Allocates on huge pages. Default-constructed values are left uninitialized, so that the thread that writes them
/// touches their pages first.
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

/// For arrays in which every value is written before it is read, either as the array grows or after resize().
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

/// Fetches values of the corners of a later triangle into the cache: many files list neighbours far apart.
template <class... Value>
void prefetch_corners(std::span<const Triangle> triangles, std::size_t current, const Value*... values) {
    constexpr std::size_t ahead = 16;
    if (current + ahead < triangles.size())
        for (const std::uint32_t corner : triangles[current + ahead])
            (__builtin_prefetch(values + corner), ...);
}

/// The peak of resident bytes since the program started or since forget_peak_resident_bytes(); 0 if the system does not
/// report it. Unlike the peak from getrusage(), it excludes the parent process.
std::size_t peak_resident_bytes();

/// Resets peak_resident_bytes().
void forget_peak_resident_bytes();

/// The memory of the machine in bytes, or the limit of the process's control group (cgroup v2) if that is less;
/// infinite if the system reports neither.
double system_memory();

/// The smallest `memory.max` of a control group and the groups that contain it; infinite if none has a limit.
/// `membership` is a file such as /proc/self/cgroup, `groups` a folder such as /sys/fs/cgroup.
double control_group_memory(const std::filesystem::path& membership, const std::filesystem::path& groups);

}
