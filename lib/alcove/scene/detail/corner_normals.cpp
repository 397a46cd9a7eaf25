#include "alcove/scene/detail/corner_normals.h"

#include "alcove/mesh/normals.h"

namespace alcove {

std::vector<std::array<Vec3, 3>> corner_normals(const Mesh& mesh, std::span<const Triangle> triangles) {
    // Twice the area in length, in units in which no product over- or underflows.
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
    // The faces around each vertex, one vertex after the other.
    for (std::size_t v = 1; v < begin.size(); ++v)
        begin[v] += begin[v - 1];
    std::vector<std::uint32_t> around(begin.back()), filled(begin.begin(), begin.end() - 1);
    for (std::uint32_t f = 0; f < triangles.size(); ++f)
        for (const std::uint32_t vertex : triangles[f])
            around[filled[vertex]++] = f;

    std::vector<std::array<Vec3, 3>> normals(triangles.size());
    for (std::size_t f = 0; f < triangles.size(); ++f)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t vertex = triangles[f][corner];
            if (!mesh.normals.empty() && mesh.normals[vertex] != Vec3(0.0f)) {
                normals[f][corner] = mesh.normals[vertex];
                continue;
            }
            Vec3d sum(0.0);
            constexpr double least_cosine = 0.766;    // of 40 degrees
            constexpr std::uint32_t most_faces = 256; // each is looked at for each
            const bool many = begin[vertex + 1] - begin[vertex] > most_faces;
            if (many)
                sum = faces[f];
            for (std::uint32_t k = begin[vertex]; !many && k < begin[vertex + 1]; ++k) {
                const Vec3d& other = faces[around[k]];
                if (glm::dot(other, faces[f]) >= least_cosine * glm::length(other) * glm::length(faces[f]))
                    sum += other;
            }
            const double length = glm::length(sum);
            normals[f][corner] = length > 0.0 ? Vec3(sum / length) : Vec3(0.0f);
        }
    return normals;
}

}
