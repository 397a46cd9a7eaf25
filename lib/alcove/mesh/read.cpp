#include "alcove/mesh/read.h"

#include "alcove/mesh/formats.h"

#include <algorithm>
#include <cctype>

namespace alcove {
namespace {

enum class Format { ply, obj, off, stl, unknown };

Format format_of(const FileBytes& file) {
    std::string extension = file.path().extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".off")
        return Format::off;
    if (extension == ".ply")
        return Format::ply;
    return Format::unknown;
}

}

Mesh read_mesh(const std::filesystem::path& path) {
    const FileBytes file(path);
    Mesh mesh;
    switch (format_of(file)) {
    case Format::off:
        mesh = read_off(file);
        break;
    default:
        file.fail("is no mesh file of a known format; PLY, OBJ, OFF and STL can be read");
    }
    return mesh;
}

}
