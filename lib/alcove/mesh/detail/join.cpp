#include "alcove/mesh/detail/join.h"

#include "alcove/base/detail/messages.h"
#include "alcove/mesh/detail/edge_table.h"
#include "alcove/mesh/detail/weld.h"

#include <numeric>

namespace alcove {
namespace {

/// The values of the vertices that represent themselves.
template <class T>
std::vector<T> first_ones(const std::vector<T>& values, std::span<const std::uint32_t> first) {
    std::vector<T> kept;
    for (std::uint32_t v = 0; v < values.size(); ++v)
        if (first[v] == v)
            kept.push_back(values[v]);
    return kept;
}

InputError refusal(const Mesh& mesh, const std::string& why) {
    return InputError((mesh.name.empty() ? "" : mesh.name + ": ") + "--weld: " + why);
}

}

JoinedMesh join_vertices(const Mesh& mesh, const Length& within) {
    const auto distance = [&] {
        try {
            const double diagonal = frame_of(mesh.box()).diagonal;
            return double(within.to_unit(diagonal)) * diagonal;
        } catch (const InputError& error) {
            throw refusal(mesh, error.what());
        }
    }();
    const std::vector<std::uint32_t> first = weld(mesh.positions, distance);
    JoinedMesh joined{mesh, std::vector<std::uint32_t>(first.size())};
    joined.mesh.source.reset();
    joined.mesh.attributes.clear();
    const SoundFaces before = sound_faces(mesh, weld(mesh.positions)), after = sound_faces(mesh, first);
    if (before.count() > 0 && after.count() == 0)
        throw refusal(mesh, "joins the corners of every face: use a smaller length");
    const std::size_t lost = after.collapsed - before.collapsed;
    if (lost > 0)
        joined.mesh.warnings.push_back(counted(lost, "face has", "faces have") +
                                       " fewer than three corners once vertices are joined; ignored: join less with a "
                                       "smaller --weld");
    if (!mesh.normals.empty()) {
        std::iota(joined.vertex_of.begin(), joined.vertex_of.end(), 0u);
        for (std::size_t v = 0; v < first.size(); ++v)
            joined.mesh.positions[v] = mesh.positions[first[v]];
        return joined;
    }
    std::uint32_t count = 0;
    for (std::uint32_t v = 0; v < first.size(); ++v)
        joined.vertex_of[v] = first[v] == v ? count++ : joined.vertex_of[first[v]];
    for (std::uint32_t& corner : joined.mesh.corners)
        corner = joined.vertex_of[corner];
    joined.mesh.positions = first_ones(mesh.positions, first);
    joined.mesh.vertex_uvs = first_ones(mesh.vertex_uvs, first);
    joined.mesh.vertex_colors = first_ones(mesh.vertex_colors, first);
    return joined;
}

}
