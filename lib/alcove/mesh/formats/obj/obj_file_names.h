/// Adapts the names of other files in an OBJ text, such as material libraries, when the text is written to another
/// folder.
#pragma once

#include "alcove/mesh/formats/file_bytes.h"
#include "alcove/mesh/formats/obj/obj_document.h"

#include <filesystem>
#include <string>
#include <vector>

namespace alcove {

/// A piece of a text, and its replacement.
struct Replacement {
    std::size_t begin, end;
    std::string text;
};

struct MovedNames {
    std::vector<Replacement> replacements; ///< in the order of the text
    std::vector<std::string> warnings;
};

/// Finds the relative names on the `file_lines` of the document and replaces them so that they lead from `folder` to
/// the same files. Names may contain blanks, be in quotes, and have backslashes between folders. Names of files that do
/// not exist are kept. `text` holds the text of the document.
MovedNames moved_names(const ObjDocument& document, const FileBytes& text, const std::filesystem::path& folder);

}
