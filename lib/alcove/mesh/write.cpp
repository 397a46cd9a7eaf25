#include "alcove/mesh/write.h"

#include "alcove/errors.h"
#include "alcove/mesh/formats.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace alcove {

std::vector<std::string> write_mesh(const Mesh& mesh, const std::filesystem::path& file,
                                    const WriteOptions& options) {
    if (!options.colors.empty() && options.colors.size() != mesh.vertex_count())
        throw std::invalid_argument("the colours to write are not one a vertex");
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".ply")
        return write_ply(mesh, file, options);
    if (extension == ".obj")
        return write_obj(mesh, file, options);
    throw InputError(file.string() + ": meshes are written as .ply or .obj; name the output so");
}

}
