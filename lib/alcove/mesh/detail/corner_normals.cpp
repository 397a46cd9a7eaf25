#include "alcove/mesh/detail/corner_normals.h"

#include "alcove/base/types.h"
#include "alcove/mesh/normals.h"
#include "alcove/mesh/triangulate.h"

namespace alcove {

std::vector<std::array<Vec3, 3>> corner_normals(const Mesh& mesh, std::span<const Triangle> triangles) {
    // Face normals, each as long as twice the area of its face, scaled so that no product over- or underflows.
    const double scale = exact_scale(mesh);
    std::vector<Vec3d> faces;
    std::vector<std::uint32_t> begin(mesh.positions.size() + 1, 0);
    for (const Triangle& t : triangles) {
        const Vec3d a = scale * mesh.positions[t[0]], b = scale * mesh.positions[t[1]],
                    c = scale * mesh.positions[t[2]];
        faces.push_back(glm::cross(b - a, c - a));
        for (const std::uint32_t vertex : t)
            ++begin[vertex + 1];
    }
    // Adjacency lists: the faces around each vertex, vertex by vertex.
    for (std::size_t v = 1; v < begin.size(); ++v)
        begin[v] += begin[v - 1];
    std::vector<std::uint32_t> around(begin.back()), filled(begin.begin(), begin.end() - 1);
    for (std::uint32_t f = 0; f < triangles.size(); ++f)
        for (const std::uint32_t vertex : triangles[f])
            around[filled[vertex]++] = f;

    const std::vector<Triangle> corners =
        mesh.corner_normals.empty() ? std::vector<Triangle>() : corners_of_triangles(mesh);
    std::vector<std::array<Vec3, 3>> normals(triangles.size());
    for (std::size_t f = 0; f < triangles.size(); ++f)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = triangles[f][corner];
            if (!corners.empty() && mesh.corner_normals[corners[f][corner]] != Vec3(0.0f)) {
                normals[f][corner] = mesh.corner_normals[corners[f][corner]];
                continue;
            }
            if (!mesh.normals.empty() && mesh.normals[vertex] != Vec3(0.0f)) {
                normals[f][corner] = mesh.normals[vertex];
                continue;
            }
            Vec3d sum(0.0);
            constexpr double min_cosine = 0.766;     // cos 40°
            constexpr std::uint32_t max_faces = 256; // because the work is quadratic in the faces of a vertex
            const bool many = begin[vertex + 1] - begin[vertex] > max_faces;
            if (many)
                sum = faces[f];
            for (std::uint32_t k = begin[vertex]; !many && k < begin[vertex + 1]; ++k) {
                const Vec3d& other = faces[around[k]];
                if (glm::dot(other, faces[f]) >= min_cosine * glm::length(other) * glm::length(faces[f]))
                    sum += other;
            }
            const double length = glm::length(sum);
            normals[f][corner] = length > 0.0 ? Vec3(sum / length) : Vec3(0.0f);
        }
    return normals;
}

std::vector<std::array<Vec3, 3>> corner_normals(const Mesh& mesh, std::span<const Triangle> triangles,
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
