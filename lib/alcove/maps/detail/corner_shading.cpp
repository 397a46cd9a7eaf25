#include "alcove/maps/detail/corner_shading.h"

#include "alcove/base/types.h"
#include "alcove/mesh/detail/corner_normals.h"

namespace alcove {

std::vector<std::array<Vec3, 3>> shading_normals(const Mesh& mesh, std::span<const Triangle> triangles,
                                                 NormalSource source) {
    if (source == NormalSource::file && mesh.normals.empty())
        throw InputError("--normals file needs normals in the file: use --normals auto");
    if (source == NormalSource::automatic || source == NormalSource::file)
        return corner_normals(mesh, triangles);
    const std::vector<Vec3> of_vertices = source == NormalSource::angle ? angle_weighted_normals(mesh, triangles)
                                                                        : area_weighted_normals(mesh, triangles);
    std::vector<std::array<Vec3, 3>> normals;
    normals.reserve(triangles.size());
    for (const Triangle& t : triangles)
        normals.push_back({of_vertices[t[0]], of_vertices[t[1]], of_vertices[t[2]]});
    return normals;
}

}
