/// A finer mesh than setup unpacks.
#pragma once

#include "alcove/mesh/triangulate.h"

#include <map>

namespace alcove {

/// Every triangle split in four at the middles of its edges.
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
        for (const Triangle& t :
             {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}})
            fine.add_face(t);
    }
    return fine;
}

}
