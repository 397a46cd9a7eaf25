/// The text of an OBJ file, and the positions of its vertices in it.
#pragma once

#include "alcove/mesh/detail/source.h"
#include "alcove/mesh/formats/text_encoding.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace alcove {

class ObjDocument : public SourceDocument {
  public:
    std::string_view text; ///< of the whole file, in memory that `keeper` owns
    std::shared_ptr<const void> keeper;
    std::filesystem::path folder;          ///< that of the file, from which it names other files
    std::vector<std::size_t> vertex_lines; ///< byte offset of the 'v' of each vertex, in file order
    std::vector<std::size_t> file_lines;   ///< byte offset of each keyword that is followed by names of files
    std::string_view comment(std::string_view beginning) const override {
        const std::string line = "\n# " + std::string(beginning);
        const std::string_view start = without_byte_order_mark(text);
        const std::size_t place = start.starts_with(line.substr(1)) ? text.size() - start.size() : text.find(line);
        if (place == std::string::npos)
            return {};
        const std::size_t at = text.find(beginning, place);
        return text.substr(at, text.find_first_of("\r\n", at) - at);
    }

    /// The faces from `first_face` to the next use have the material `name`.
    struct MaterialUse {
        std::size_t first_face;
        std::string name;
    };
    std::vector<MaterialUse> material_uses;  ///< in file order
    std::vector<std::string> material_files; ///< what follows each 'mtllib': one name or several

    std::size_t weights = 0;    ///< vertices whose fourth coordinate is not 1
    std::size_t mrgb_lines = 0; ///< comments that hold colours

    /// Lines that a Mesh cannot represent: a description ("'usemtl' lines") and a count above 0.
    std::vector<std::pair<std::string, std::size_t>> other_lines;
};

}
