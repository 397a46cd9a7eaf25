/// The two halves of a PLY file: the header in words, then the rows it announces.
#pragma once

#include "alcove/mesh/formats/file_bytes.h"
#include "alcove/mesh/formats/ply/ply_document.h"

namespace alcove {

enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    PlyDocument document;                   ///< its elements without rows
    const char* body = nullptr;             ///< the first byte behind end_header
    std::vector<const char*> element_line;  ///< where each element is announced
    std::vector<const char*> element_begin; ///< where the rows of each element begin, once they are parsed
};

/// \throw InputError naming the line: a keyword, type or count that is none, a name used twice, no
/// end_header.
PlyHeader parse_ply_header(const FileBytes& file);

/// Fills the rows of all elements, converted to the binary little-endian layout. Counts are checked against
/// the bytes left before memory is taken for them. \return bytes behind the last row. \throw InputError
/// naming the line or byte.
std::size_t parse_ply_rows(const FileBytes& file, PlyHeader& header);

/// \throw InputError for something found in a parsed row: the line of an ascii file, else the byte, `offset`
/// bytes behind the first of the element.
[[noreturn]] void fail_in_row(const FileBytes& file, const PlyHeader& header, const PlyElement& element,
                              std::size_t row, std::size_t offset, const std::string& message);

}
