#include "alcove/bake/detail/input_warnings.h"

#include "alcove/bake/detail/gap_warnings.h"
#include "alcove/base/detail/messages.h"
#include "alcove/mesh/detail/outlier_faces.h"

#include <fmt/format.h>

#include <algorithm>

namespace alcove {
namespace {

/// Warns if normals of the file point away from the front of their faces, which makes everything dark.
void warn_of_flipped_normals(const BakeTarget& target, std::vector<std::string>& warnings) {
    constexpr std::size_t most_faces = 4096;
    const std::size_t stride = std::max<std::size_t>(target.triangles.size() / most_faces, 1);
    std::size_t against = 0, compared = 0;
    for (std::size_t i = 0; i < target.triangles.size(); i += stride) {
        const Triangle& t = target.triangles[i];
        const std::vector<Vec3d>& p = target.mesh.positions;
        const Vec3 normal = unit_or_zero(glm::cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
        for (const std::uint32_t v : t) {
            const float cosine = glm::dot(normal, target.surfels[v].normal);
            compared += cosine != 0.0f;
            against += cosine < 0.0f;
        }
    }
    if (2 * against > compared)
        warnings.push_back(
            fmt::format("the normals of the file point away from the front of the faces at {:.0f} % of the "
                        "vertices: use --normals angle, or flip the normals",
                        100.0 * static_cast<double>(against) / static_cast<double>(compared)));
}

void warn_of_hard_edges(const Mesh& mesh, std::vector<std::string>& warnings) {
    if (mesh.corner_normals.empty())
        return;
    std::vector<Vec3> first(mesh.vertex_count(), Vec3(0.0f));
    std::vector<std::uint8_t> has_several(mesh.vertex_count(), 0);
    for (std::size_t c = 0; c < mesh.corner_normals.size(); ++c) {
        Vec3& known = first[mesh.corners[c]];
        const Vec3& normal = mesh.corner_normals[c];
        if (known == Vec3(0.0f))
            known = normal;
        else if (normal != Vec3(0.0f) && normal != known)
            has_several[mesh.corners[c]] = 1;
    }
    const auto several = static_cast<std::size_t>(std::count(has_several.begin(), has_several.end(), 1));
    if (several > 0)
        warnings.push_back(counted(several, "vertex has several normals (hard edges) but stores",
                                   "vertices have several normals (hard edges) but store") +
                           " one value, computed for their average; split the vertices there before export (Blender: "
                           "Edge Split) to get one value per side");
}

void warn_of_missing_normals(std::span<const Surfel> surfels, std::string_view what,
                             std::vector<std::string>& warnings) {
    const auto missing = std::count_if(surfels.begin(), surfels.end(), [](const Surfel& s) { return !s.has_normal(); });
    if (missing > 0)
        warnings.push_back(fmt::format(
            "{} of {} {} {} and got ao = 1", grouped(static_cast<std::size_t>(missing)), grouped(surfels.size()), what,
            missing == 1 ? "has no normal (no face uses it, or its face normals cancel out)"
                         : "have no normal (no face uses them, or their face normals cancel out)"));
}

void warn_of_offset(const BakeTarget& target, std::vector<std::string>& warnings) {
    constexpr float noticeable = 0.02f;
    const float offset = ray_offset(target.radius);
    if (offset > noticeable * target.radius)
        warnings.push_back(fmt::format(
            "the radius is only {:.2g} of the diagonal: rays have to start {:.2g} of the radius above the "
            "surface, which brightens creases; use a larger radius, or bake the parts of the scene one at a time",
            target.radius, offset / target.radius));
}

/// Warns if a few outlying faces determine the diagonal: then lengths in percent of the diagonal make no sense.
void warn_of_outliers(const BakeTarget& target, const Length& radius, std::vector<std::string>& warnings) {
    if (radius.unit != Length::Unit::diagonal)
        return;
    if (const std::optional<OutlierFaces> outliers = find_outlier_faces(target.mesh)) {
        warnings.push_back(fmt::format(
            "{}, so the radius is {:.3g}: remove {}, or give the radius in scene units, such as --radius {:.2g}",
            outliers->text(target.mesh), target.radius * target.frame.diagonal, outliers->count == 1 ? "it" : "them",
            0.1 * outliers->rest.diagonal()));
    }
}

}

std::vector<std::string> input_warnings(const BakeTarget& target, std::string_view name, bool of_vertices,
                                        const BakeOptions& options) {
    std::vector<std::string> warnings;
    if (of_vertices) {
        const bool of_file = !target.mesh.normals.empty() &&
                             (options.normals == NormalSource::automatic || options.normals == NormalSource::file);
        warnings = gap_warnings(target.mesh, target.triangles, target.surfels, of_file);
        if (of_file) {
            warn_of_flipped_normals(target, warnings);
            warn_of_hard_edges(target.mesh, warnings);
        }
    }
    if (options.faces.empty()) // a selection removes normals on purpose
        warn_of_missing_normals(target.surfels, name, warnings);
    warn_of_outliers(target, options.radius, warnings);
    warn_of_offset(target, warnings);
    return warnings;
}

}
