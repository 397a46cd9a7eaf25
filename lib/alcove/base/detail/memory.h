/// Large arrays on pages of 2 MB, and the memory of the process and of the machine. Allocating a page takes longer than
/// filling it, and a mesh of a million triangles occupies tens of thousands of small pages.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace alcove {

/// Requests huge pages where they fit into [begin, begin + bytes). A hint, without effect on systems without them.
void prefer_huge_pages(void* begin, std::size_t bytes);

/// Keeps freed memory in the process from now on. Otherwise the system clears each page again before a later array gets
/// it, which takes a tenth of the time of a bake. For programs, not for libraries. No effect without glibc.
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

/// For arrays whose values are all written, either as the array grows or after resize().
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

/// The peak of resident bytes since the program started or since forget_peak_resident_bytes(); 0 if the system does not
/// report it. Unlike the peak from getrusage(), it excludes the parent process.
std::size_t peak_resident_bytes();

/// Resets the peak.
void forget_peak_resident_bytes();

/// Bytes of memory of the machine, or of the control group (cgroup v2) if that has less; infinite if the system reports
/// neither.
double system_memory();

/// The smallest `memory.max` of a control group and of the groups that contain it; infinite if there is none.
/// `membership` is a file such as /proc/self/cgroup, `groups` a folder such as /sys/fs/cgroup.
double control_group_memory(const std::filesystem::path& membership, const std::filesystem::path& groups);

}
