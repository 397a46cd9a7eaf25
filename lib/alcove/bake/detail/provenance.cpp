#include "alcove/bake/detail/provenance.h"

#include "alcove/mesh/detail/source.h"

#include <algorithm>

namespace alcove {

std::string_view earlier_bake(const Mesh& mesh) {
    return mesh.source ? mesh.source->comment(provenance) : std::string_view();
}

bool has_baked_colors(const Mesh& mesh) {
    const auto is_grey = [](const Color& color) { return color[0] == color[1] && color[1] == color[2]; };
    return !earlier_bake(mesh).empty() && !mesh.vertex_colors.empty() &&
           (mesh.format != "PLY" || mesh.source->has_vertex_property("quality")) &&
           std::all_of(mesh.vertex_colors.begin(), mesh.vertex_colors.end(), is_grey);
}

}
