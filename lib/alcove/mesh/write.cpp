#include "alcove/mesh/files.h"

#include "alcove/base/detail/atomic_file.h"
#include "alcove/base/detail/file_kind.h"
#include "alcove/base/types.h"
#include "alcove/mesh/formats/formats.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace alcove {

namespace {

using Writer = std::vector<std::string> (*)(const Mesh&, const std::filesystem::path&);

Writer writer_for(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    if (extension == ".ply")
        return write_ply;
    if (extension == ".obj")
        return write_obj;
    return extension == ".glb" || extension == ".gltf" ? write_gltf : nullptr;
}

}

bool can_write_mesh(const std::filesystem::path& file) {
    if (!writer_for(file))
        return false;
    const AtomicFile probe(file);
    return true;
}

std::vector<std::string> write_mesh(const Mesh& mesh, const std::filesystem::path& file) {
    if (!mesh.added_colors.empty() && mesh.added_colors.size() != mesh.vertex_count())
        throw std::invalid_argument("the number of colours to write differs from the number of vertices");
    if (const Writer write = writer_for(file))
        return write(mesh, file);
    throw InputError(file.string() + ": meshes are written as .ply, .obj, .glb or .gltf; use one of these extensions");
}

}
