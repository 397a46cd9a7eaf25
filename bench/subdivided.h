/// Finer meshes than those that tools/setup.sh unpacks.
#pragma once

#include "alcove/mesh/normals.h"
#include "alcove/mesh/triangulate.h"
#include "alcove/occlusion/detail/directions.h"

#include <algorithm>
#include <map>

namespace alcove {

/// Splits every triangle into four at the midpoints of its edges.
inline Mesh subdivided(const Mesh& mesh) {
    Mesh fine;
    fine.positions = mesh.positions;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [at, added] =
            middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(fine.positions.size()));
        if (added)
            fine.positions.push_back(0.5 * (mesh.positions[a] + mesh.positions[b]));
        return at->second;
    };
    for (const auto& [a, b, c] : triangulate(mesh).triangles) {
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        for (const Triangle& t : {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}})
            fine.add_face(t);
    }
    return fine;
}

/// Smooth noise in [−1, 1] with waves about two units long: random values at integer points, interpolated by smoothstep
/// (Perlin 1985).
inline double value_noise(const Vec3d& p) {
    const Vec3d cell = glm::floor(p), part = p - cell, t = part * part * (3.0 - 2.0 * part);
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
        const double random = 2.0 * unit_interval(hash(Vec3(cell + Vec3d(step)), 0)) - 1.0;
        const Vec3d weight = glm::mix(1.0 - t, t, Vec3d(step));
        sum += random * weight.x * weight.y * weight.z;
    }
    return sum;
}

/// Moves the vertices along their normals by noise: waves one mean edge high and 16 edges long, plus waves half as high
/// and 8 edges long.
inline Mesh displaced(Mesh mesh) {
    const std::vector<Triangle> triangles = triangulate(mesh).triangles;
    const std::vector<Vec3> normals = angle_weighted_normals(mesh, triangles);
    double edge = 0.0;
    for (const Triangle& t : triangles)
        edge += glm::length(mesh.positions[t[0]] - mesh.positions[t[1]]) / static_cast<double>(triangles.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const Vec3d at = mesh.positions[v] / edge;
        mesh.positions[v] += edge * (value_noise(at / 8.0) + 0.5 * value_noise(at / 4.0 + 7.0)) * Vec3d(normals[v]);
    }
    return mesh;
}

}
