#include "alcove/scene/detail/own_colors.h"

#include "alcove/bake/detail/provenance.h"
#include "alcove/base/detail/messages.h"
#include "alcove/mesh/formats/obj/materials.h"
#include "alcove/render/renderer.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace alcove {
namespace {

std::vector<Vec3> decoded(const std::vector<Color>& colors) {
    std::vector<Vec3> result;
    result.reserve(colors.size());
    std::transform(colors.begin(), colors.end(), std::back_inserter(result), linear_light);
    return result;
}

void warn_of_alpha(const std::vector<Color>& colors, OwnColors& result) {
    const auto count = std::count_if(colors.begin(), colors.end(), [](const Color& color) { return color[3] < 255; });
    if (count > 0)
        result.warnings.push_back("the alpha of " + counted(static_cast<std::size_t>(count), "colour", "colours") +
                                  " is not shown: surfaces are opaque");
}

void take_materials(const Mesh& mesh, OwnColors& result) {
    FaceMaterials materials = read_materials(mesh);
    std::move(materials.warnings.begin(), materials.warnings.end(), std::back_inserter(result.warnings));
    const auto has_color = [](const std::optional<Vec3>& color) { return color.has_value(); };
    if (std::none_of(materials.diffuse.begin(), materials.diffuse.end(), has_color))
        return;
    for (const std::optional<Vec3>& kd : materials.diffuse)
        result.of_faces.push_back(kd ? Vec3(srgb_decoded(kd->x), srgb_decoded(kd->y), srgb_decoded(kd->z))
                                     : Material{}.color);
}

}

float srgb_decoded(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

Vec3 linear_light(const Color& color) {
    const auto channel = [&](std::size_t c) { return srgb_decoded(static_cast<float>(color[c]) / 255.0f); };
    return {channel(0), channel(1), channel(2)};
}

bool may_have_colors(const Mesh& mesh) {
    return !mesh.vertex_colors.empty() || !mesh.face_colors.empty() || has_materials(mesh);
}

OwnColors own_colors(const Mesh& mesh) {
    OwnColors result;
    const bool baked = has_baked_colors(mesh);
    if (baked)
        result.warnings.emplace_back(
            "the vertex colours are the ao of an earlier bake: not shown, as the image would apply it twice");
    if (!mesh.vertex_colors.empty() && !baked) {
        result.of_vertices = decoded(mesh.vertex_colors);
        warn_of_alpha(mesh.vertex_colors, result);
        if (!mesh.face_colors.empty() || has_materials(mesh))
            result.warnings.emplace_back("the colours of the faces are not shown, because the vertices have some too");
    } else if (!mesh.face_colors.empty()) {
        result.of_faces = decoded(mesh.face_colors);
        warn_of_alpha(mesh.face_colors, result);
    } else {
        take_materials(mesh, result);
    }
    return result;
}

}
