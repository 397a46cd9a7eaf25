#include "alcove/mesh/detail/parts.h"

#include "alcove/mesh/detail/edge_table.h"
#include "alcove/mesh/detail/weld.h"

#include <algorithm>

namespace alcove {
namespace {

/// The faces of each component, as indices of sound faces.
std::vector<std::vector<std::uint32_t>> components_of(const Mesh& mesh, const SoundFaces& faces) {
    DisjointSets sets(faces.count());
    EdgeTable(faces, mesh.vertex_count()).for_each_edge([&](std::span<const EdgeUse> uses) {
        for (const EdgeUse& use : uses.subspan(1))
            sets.join(faces.face_of[uses[0].corner], faces.face_of[use.corner]);
    });
    std::vector<std::vector<std::uint32_t>> components;
    std::vector<std::uint32_t> number(faces.count());
    for (std::uint32_t f = 0; f < faces.count(); ++f) {
        const std::uint32_t first = sets.find(f); // the smallest of its set, so the set has a number
        if (first == f) {
            number[f] = static_cast<std::uint32_t>(components.size());
            components.emplace_back();
        }
        components[number[first]].push_back(f);
    }
    return components;
}

}

std::vector<MeshPart> split_parts(const Mesh& mesh) {
    const SoundFaces faces = sound_faces(mesh, weld(mesh.positions));
    std::vector<MeshPart> parts;
    std::vector<std::uint32_t> new_index(mesh.vertex_count()), corners;
    for (const std::vector<std::uint32_t>& component : components_of(mesh, faces)) {
        MeshPart& part = parts.emplace_back();
        for (const std::uint32_t f : component) {
            const auto face = mesh.face(faces.source[f]);
            part.vertices.insert(part.vertices.end(), face.begin(), face.end());
        }
        std::sort(part.vertices.begin(), part.vertices.end());
        part.vertices.erase(std::unique(part.vertices.begin(), part.vertices.end()), part.vertices.end());
        for (std::uint32_t i = 0; i < part.vertices.size(); ++i) {
            const std::uint32_t v = part.vertices[i];
            new_index[v] = i;
            part.mesh.positions.push_back(mesh.positions[v]);
            if (!mesh.normals.empty())
                part.mesh.normals.push_back(mesh.normals[v]);
        }
        for (const std::uint32_t f : component) {
            const auto face = mesh.face(faces.source[f]);
            corners.resize(face.size());
            std::transform(face.begin(), face.end(), corners.begin(), [&](std::uint32_t v) { return new_index[v]; });
            part.mesh.add_face(corners);
        }
    }
    return parts;
}

}
