/// The text of an OBJ file, and the places in the text where its vertices are.
#pragma once

#include "alcove/base/detail/messages.h"
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
    std::filesystem::path folder;          ///< of the file; the names of other files are relative to it
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
    std::vector<std::string> material_files; ///< the rest of each 'mtllib' line: one name or several

    std::size_t weights = 0;    ///< vertices whose fourth coordinate is not 1
    std::size_t mrgb_lines = 0; ///< comments that hold colours

    /// Lines that a Mesh cannot represent: a description ("'usemtl' lines") and a count above 0.
    std::vector<std::pair<std::string, std::size_t>> other_lines;

    /// One text for each of other_lines: "2 'usemtl' lines", "1 comment line".
    std::vector<std::string> other_line_counts() const {
        constexpr std::string_view plural = "lines"; // ends each description
        std::vector<std::string> counts;
        for (const auto& [what, count] : other_lines) {
            std::string one = what;
            one.erase(what.find(plural) + plural.size() - 1, 1);
            counts.push_back(counted(count, one, what));
        }
        return counts;
    }
    std::vector<std::string> contents() const override {
        std::vector<std::string> all = other_line_counts();
        if (weights > 0)
            all.push_back("the weights of " + counted(weights, "vertex", "vertices"));
        return all;
    }
};

}
