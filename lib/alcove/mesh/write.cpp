#include "alcove/mesh/write.h"

#include "alcove/base/detail/atomic_file.h"
#include "alcove/base/errors.h"
#include "alcove/mesh/formats/formats.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace alcove {

namespace {

using Writer = std::vector<std::string> (*)(const Mesh&, const std::filesystem::path&, const WriteOptions&);

Writer writer_for(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension == ".ply" ? write_ply : extension == ".obj" ? write_obj : nullptr;
}

}

bool can_write_mesh(const std::filesystem::path& file) {
    if (!writer_for(file))
        return false;
    const AtomicFile probe(file);
    return true;
}

std::vector<std::string> write_mesh(const Mesh& mesh, const std::filesystem::path& file,
                                    const WriteOptions& options) {
    if (!options.colors.empty() && options.colors.size() != mesh.vertex_count())
        throw std::invalid_argument("the colours to write are not one a vertex");
    if (const Writer write = writer_for(file))
        return write(mesh, file, options);
    throw InputError(file.string() + ": meshes are written as .ply or .obj; name the output so");
}

}
