/// The counts that a file declares, determined independently of the readers.
#pragma once

#include <cstdint>
#include <string>

struct Announced {
    std::uint64_t vertices = 0, faces = 0;
    bool operator==(const Announced&) const = default;
};

/// The counts of a file that can be read: the declared ones of PLY, OFF and binary STL, the numbers of lines of
/// OBJ, and of the facets of an STL text. The vertices of STL are its corners.
Announced announced_by(const std::string& bytes, std::string_view format);
