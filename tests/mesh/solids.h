/// Builds and modifies small meshes.
#pragma once

#include "alcove/mesh/mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alcove {

using Face = std::vector<std::uint32_t>;

/// A cube of quads, faces outward, with corners at `low` + {0, size}.
inline Mesh cube(const Vec3d& low = Vec3d(0.0), double size = 1.0) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < 8; ++i)
        mesh.positions.push_back(low + size * Vec3d(i & 1, (i >> 1) & 1, i >> 2));
    for (const Face& face :
         {Face{0, 2, 3, 1}, Face{4, 5, 7, 6}, Face{0, 1, 5, 4}, Face{2, 6, 7, 3}, Face{0, 4, 6, 2}, Face{1, 3, 7, 5}})
        mesh.add_face(face);
    return mesh;
}

inline Mesh tetrahedron() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const Face& face : {Face{0, 2, 1}, Face{0, 1, 3}, Face{0, 3, 2}, Face{1, 2, 3}})
        mesh.add_face(face);
    return mesh;
}

inline std::vector<Face> faces_of(const Mesh& mesh) {
    std::vector<Face> faces;
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        faces.emplace_back(mesh.face(f).begin(), mesh.face(f).end());
    return faces;
}

inline Mesh with_faces(const Mesh& mesh, const std::vector<Face>& faces) {
    Mesh result;
    result.positions = mesh.positions;
    for (const Face& face : faces)
        result.add_face(face);
    return result;
}

inline Mesh inverted(const Mesh& mesh) {
    std::vector<Face> faces = faces_of(mesh);
    for (Face& face : faces)
        std::reverse(face.begin(), face.end());
    return with_faces(mesh, faces);
}

inline Mesh together(const Mesh& a, const Mesh& b) {
    std::vector<Face> faces = faces_of(a);
    for (Face face : faces_of(b)) {
        for (std::uint32_t& v : face)
            v += static_cast<std::uint32_t>(a.vertex_count());
        faces.push_back(face);
    }
    Mesh both = with_faces(a, {});
    both.positions.insert(both.positions.end(), b.positions.begin(), b.positions.end());
    return with_faces(both, faces);
}

/// A copy in which no faces share vertices.
inline Mesh split(const Mesh& mesh) {
    Mesh result;
    for (Face face : faces_of(mesh)) {
        for (std::uint32_t& v : face) {
            result.positions.push_back(mesh.positions[v]);
            v = static_cast<std::uint32_t>(result.positions.size() - 1);
        }
        result.add_face(face);
    }
    return result;
}

/// A torus of m × n vertices and quads.
inline Mesh torus(std::uint32_t m, std::uint32_t n) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < m; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const double u = 2 * std::numbers::pi * i / m, v = 2 * std::numbers::pi * j / n;
            const double r = 3 + std::cos(v);
            mesh.positions.emplace_back(r * std::cos(u), r * std::sin(u), std::sin(v));
            const std::uint32_t k = (i + 1) % m, l = (j + 1) % n;
            mesh.add_face(Face{i * n + j, k * n + j, k * n + l, i * n + l});
        }
    return mesh;
}

}
