/// Parses the two parts of a PLY file: the header, then the rows that it declares.
#pragma once

#include "alcove/mesh/formats/file_bytes.h"
#include "alcove/mesh/formats/ply/ply_document.h"

namespace alcove {

enum class PlyFormat { ascii, little_endian, big_endian };

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    PlyDocument document;                   ///< its elements have no rows
    const char* body = nullptr;             ///< the first byte after end_header
    std::vector<const char*> element_line;  ///< where each element is declared
    std::vector<const char*> element_begin; ///< where the rows of each element begin, once they are parsed
};

/// \throw InputError, which names the line, for an invalid keyword, type or count, a duplicate name, or a missing
/// end_header.
PlyHeader parse_ply_header(const FileBytes& file);

/// Fills the rows of all elements, converted to the binary little-endian layout. Checks counts against the bytes left
/// before it allocates memory. \return the number of bytes after the last row. \throw InputError, which names the line
/// or byte.
std::size_t parse_ply_rows(const FileBytes& file, PlyHeader& header);

/// \throw InputError for an error in a parsed row. The message names the line in an ascii file, and the byte at
/// `offset` from the start of the element in a binary file.
[[noreturn]] void fail_in_row(const FileBytes& file, const PlyHeader& header, const PlyElement& element,
                              std::size_t row, std::size_t offset, const std::string& message);

}
