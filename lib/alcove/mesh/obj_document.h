/// An OBJ file as it was, and where its vertices stand in it.
#pragma once

#include "alcove/mesh/source.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace alcove {

class ObjDocument : public SourceDocument {
  public:
    std::string text;
    std::vector<std::size_t> vertex_lines; ///< byte offset of the 'v' of each vertex, in file order
    std::vector<std::pair<std::string, std::size_t>> keywords; ///< of lines that a Mesh has no place for, and how many

    /// "3 'usemtl' lines", one string a keyword.
    std::vector<std::string> other_lines() const;
};

}
