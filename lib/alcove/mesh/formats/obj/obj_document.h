/// The text of an OBJ file, and the positions of its vertices in it.
#pragma once

#include "alcove/mesh/detail/source.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace alcove {

class ObjDocument : public SourceDocument {
  public:
    std::string text;
    std::vector<std::size_t> vertex_lines; ///< byte offset of the 'v' of each vertex, in file order
    bool has_comment(std::string_view beginning) const override {
        return text.find("\n# " + std::string(beginning)) != std::string::npos ||
               text.starts_with("# " + std::string(beginning));
    }

    /// The faces from `first_face` to the next use have the material `name`.
    struct MaterialUse {
        std::size_t first_face;
        std::string name;
    };
    std::vector<MaterialUse> material_uses;  ///< in file order
    std::vector<std::string> material_files; ///< what follows each 'mtllib': one name or several

    std::size_t weights = 0; ///< vertices whose fourth coordinate is not 1

    /// Lines that a Mesh cannot represent: a description ("'usemtl' lines") and a count above 0.
    std::vector<std::pair<std::string, std::size_t>> other_lines;
};

}
