/// What a file says that it holds, found without the readers.
#pragma once

#include <cstdint>
#include <string>

struct Announced {
    std::uint64_t vertices = 0, faces = 0;
    bool operator==(const Announced&) const = default;
};

/// Of a file that was read: the counts of PLY, OFF and binary STL, the lines of OBJ, the facets of an STL text and, as the
/// vertices of STL, its corners.
Announced announced_by(const std::string& bytes, std::string_view format);
