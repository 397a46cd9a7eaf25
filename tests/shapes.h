/// Small meshes for tests with closed-form results.
#pragma once

#include "alcove/mesh/mesh.h"

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

namespace alcove::test {

/// A unit sphere: an octahedron subdivided `level` times, with vertices projected to the sphere and faces outward.
/// `keep` selects faces by their centre.
inline Mesh sphere_mesh(
    int level, const std::function<bool(const Vec3d&)>& keep = [](const Vec3d&) { return true; }) {
    std::vector<Vec3d> points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<Triangle> faces{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int l = 0; l < level; ++l) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [at, added] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points.size()));
            if (added)
                points.push_back(glm::normalize(points[a] + points[b]));
            return at->second;
        };
        std::vector<Triangle> split;
        for (const auto& [a, b, c] : faces) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            split.insert(split.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        faces = std::move(split);
    }
    Mesh mesh;
    mesh.positions = points;
    for (const Triangle& f : faces)
        if (keep((points[f[0]] + points[f[1]] + points[f[2]]) / 3.0))
            mesh.add_face(f);
    return mesh;
}

/// Adds the faces of `part` to a mesh, first scaled and then moved.
inline void add_part(Mesh& mesh, const Mesh& part, double scale, const Vec3d& move) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3d& p : part.positions)
        mesh.positions.push_back(scale * p + move);
    for (std::size_t f = 0; f < part.face_count(); ++f) {
        std::vector<std::uint32_t> face(part.face(f).begin(), part.face(f).end());
        for (std::uint32_t& v : face)
            v += first;
        mesh.add_face(face);
    }
}

/// A box with the given half extents around the origin. Each side has n × n quads with shared corners; faces outward.
inline Mesh box_mesh(const Vec3d& half, int n) {
    Mesh mesh;
    std::map<std::array<int, 3>, std::uint32_t> known;
    const auto vertex = [&](const std::array<int, 3>& at) {
        const auto [it, added] = known.try_emplace(at, static_cast<std::uint32_t>(mesh.positions.size()));
        if (added)
            mesh.positions.push_back(half * (2.0 * Vec3d(at[0], at[1], at[2]) / double(n) - 1.0));
        return it->second;
    };
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side)
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const auto corner = [&](int u, int v) {
                        std::array<int, 3> at{};
                        at[static_cast<std::size_t>(axis)] = side * n;
                        at[static_cast<std::size_t>((axis + 1) % 3)] = u;
                        at[static_cast<std::size_t>((axis + 2) % 3)] = v;
                        return vertex(at);
                    };
                    std::array<std::uint32_t, 4> quad{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
                                                      corner(i, j + 1)};
                    if (side == 0)
                        std::swap(quad[1], quad[3]);
                    mesh.add_face(quad);
                }
    return mesh;
}

}
