#include "alcove/mesh/mesh.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace alcove {

void Mesh::add_face(std::span<const std::uint32_t> vertices) {
    corners.insert(corners.end(), vertices.begin(), vertices.end());
    face_begin.push_back(static_cast<std::uint32_t>(corners.size()));
}

std::vector<std::uint8_t> Mesh::used_vertices() const {
    std::vector<std::uint8_t> used(vertex_count(), face_count() == 0);
    for (const std::uint32_t v : corners)
        used[v] = 1;
    return used;
}

Box Mesh::box() const {
    const std::vector<std::uint8_t> used = used_vertices();
    Box box;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const Vec3d& p = positions[v];
        if (used[v] && p.x - p.x + (p.y - p.y) + (p.z - p.z) == 0.0) // whether p is finite, with one branch
            box.add(p);
    }
    return box;
}

void Mesh::set_attribute(Attribute attribute) {
    constexpr std::array<std::string_view, 6> taken{"x", "y", "z", "nx", "ny", "nz"};
    const auto fits = [](unsigned char c) { return c > ' ' && c < 0x7f; }; // in a PLY header
    if (attribute.name.empty() || !std::all_of(attribute.name.begin(), attribute.name.end(), fits) ||
        std::find(taken.begin(), taken.end(), attribute.name) != taken.end())
        throw std::invalid_argument("'" + attribute.name + "' cannot be the name of an attribute");
    if (attribute.components < 1)
        throw std::invalid_argument("attribute '" + attribute.name + "' has no components");
    if (attribute.values.size() != vertex_count() * static_cast<std::size_t>(attribute.components))
        throw std::invalid_argument("attribute '" + attribute.name + "' does not have one value per vertex");
    const auto same = std::find_if(attributes.begin(), attributes.end(),
                                   [&](const Attribute& a) { return a.name == attribute.name; });
    if (same != attributes.end())
        *same = std::move(attribute);
    else
        attributes.push_back(std::move(attribute));
}

const Attribute* Mesh::find_attribute(std::string_view wanted) const {
    const auto found =
        std::find_if(attributes.begin(), attributes.end(), [&](const Attribute& a) { return a.name == wanted; });
    return found == attributes.end() ? nullptr : &*found;
}

}
