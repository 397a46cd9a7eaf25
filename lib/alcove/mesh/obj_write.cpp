#include "alcove/errors.h"
#include "alcove/mesh/formats.h"
#include "alcove/mesh/obj_document.h"

namespace alcove {

std::vector<std::string> ObjDocument::other_lines() const {
    return {};
}
std::vector<std::string> write_obj(const Mesh&, const std::filesystem::path& file, const WriteOptions&) {
    throw IoError(file.string() + ": obj");
}

}
