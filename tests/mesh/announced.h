/// The counts that a file declares, determined independently of the readers.
#pragma once

#include <cstdint>
#include <string>

struct Announced {
    std::uint64_t vertices = 0, faces = 0;
    bool operator==(const Announced&) const = default;
};

/// The counts of a file that can be read. For PLY, OFF and binary STL, these are the declared counts; for OBJ, the
/// numbers of lines; for an STL text, the number of facets. The vertices of STL are its corners.
Announced announced_by(const std::string& bytes, std::string_view format);
