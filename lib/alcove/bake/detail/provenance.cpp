#include "alcove/bake/detail/provenance.h"

#include "alcove/mesh/detail/source.h"

#include <algorithm>

namespace alcove {

bool is_baked(const Mesh& mesh) {
    return mesh.source && mesh.source->has_comment(provenance);
}

bool has_baked_colors(const Mesh& mesh) {
    const auto is_grey = [](const Color& color) { return color[0] == color[1] && color[1] == color[2]; };
    return is_baked(mesh) && !mesh.vertex_colors.empty() &&
           (mesh.format != "PLY" || mesh.source->has_vertex_property("quality")) &&
           std::all_of(mesh.vertex_colors.begin(), mesh.vertex_colors.end(), is_grey);
}

}
