#include "alcove/mesh/detail/tessellate.h"

#include "alcove/base/detail/messages.h"
#include "alcove/base/types.h"
#include "alcove/mesh/detail/adaptive_cuts.h"
#include "alcove/mesh/detail/bisection.h"
#include "alcove/mesh/detail/interpolated_document.h"
#include "alcove/mesh/normals.h"

#include <fmt/format.h>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alcove {
namespace {

using Vec2d = glm::dvec2;
using Vec4d = glm::dvec4;

void check_length(double length, const char* name) {
    if (!(length >= 0.0))
        throw InputError(fmt::format("tessellation needs a {} length of at least 0, not {}", name, length));
}

/// Limits the number of faces so that 32-bit indices suffice.
std::size_t face_limit(const Mesh& mesh, std::size_t most_faces) {
    const std::size_t corners_left = std::numeric_limits<std::uint32_t>::max() - mesh.corners.size();
    return std::min(most_faces, mesh.face_count() + corners_left / 3);
}

/// The smallest length, to within 1 %, for which cutting all longer edges gives at most `most_faces` faces. If there is
/// no such length, one that causes no cuts.
double length_that_fits(const Bisection& bisection, double wanted, std::size_t most_faces) {
    const double longest = bisection.longest_side();
    if (longest <= wanted || bisection.count_faces(wanted, most_faces) <= most_faces)
        return wanted;
    double low = wanted, high = 1.001 * longest;
    while (high > 1.01 * low) {
        const double middle = low * std::sqrt(high / low);
        (bisection.count_faces(middle, most_faces) <= most_faces ? high : low) = middle;
    }
    return high;
}

/// Appends the values of the added vertices.
void interpolate(std::vector<float>& values, int components, std::span<const AddedVertex> added) {
    for (const AddedVertex& vertex : added)
        for (int c = 0; c < components; ++c)
            values.push_back(static_cast<float>(blended(vertex.weights, [&](int i) {
                const std::size_t v = vertex.between[std::size_t(i)];
                return double(values[v * std::size_t(components) + std::size_t(c)]);
            })));
}

Color rounded(const Vec4d& color) {
    Color bytes;
    for (int c = 0; c < 4; ++c)
        bytes[std::size_t(c)] = static_cast<std::uint8_t>(std::lround(color[c]));
    return bytes;
}

void interpolate(std::vector<Color>& colors, std::span<const AddedVertex> added) {
    if (colors.empty())
        return;
    for (const AddedVertex& vertex : added)
        colors.push_back(rounded(blended(vertex.weights, [&](int i) {
            const auto& [r, g, b, a] = colors[vertex.between[std::size_t(i)]];
            return Vec4d(r, g, b, a);
        })));
}

void add_vertices(Mesh& mesh, const Bisection& bisection) {
    const std::vector<AddedVertex>& added = bisection.added();
    for (const AddedVertex& vertex : added) {
        const auto at = [&](const auto& values, int i) { return values[vertex.between[std::size_t(i)]]; };
        if (!mesh.normals.empty())
            mesh.normals.push_back(
                unit_or_zero(blended(vertex.weights, [&](int i) { return Vec3d(at(mesh.normals, i)); })));
        if (!mesh.vertex_uvs.empty())
            mesh.vertex_uvs.emplace_back(blended(vertex.weights, [&](int i) { return Vec2d(at(mesh.vertex_uvs, i)); }));
    }
    interpolate(mesh.vertex_colors, added);
    interpolate(mesh.added_colors, added);
    for (Attribute& attribute : mesh.attributes)
        interpolate(attribute.values, attribute.components, added);
    mesh.positions = bisection.positions();
}

/// Replaces each cut face with its pieces.
void replace_faces(Mesh& mesh, const Mesh& old, const Bisection& bisection) {
    mesh.corners.clear();
    mesh.face_begin.assign(1, 0);
    mesh.corner_uvs.clear();
    mesh.corner_normals.clear();
    mesh.face_colors.clear();
    const auto add_face = [&](std::uint32_t f, std::span<const std::uint32_t> vertices) {
        mesh.add_face(vertices);
        if (!old.face_colors.empty())
            mesh.face_colors.push_back(old.face_colors[f]);
    };
    auto piece = bisection.pieces().begin();
    const auto end = bisection.pieces().end();
    auto group = mesh.groups.begin();
    for (std::uint32_t f = 0; f < old.face_count(); ++f) {
        for (; group != mesh.groups.end() && group->first_face == f; ++group)
            group->first_face = static_cast<std::uint32_t>(mesh.face_count());
        if (!bisection.is_cut(f)) {
            add_face(f, old.face(f));
            const auto copy_corners = [&](const auto& from, auto& to) {
                if (!from.empty())
                    to.insert(to.end(), from.begin() + old.face_begin[f], from.begin() + old.face_begin[f + 1]);
            };
            copy_corners(old.corner_uvs, mesh.corner_uvs);
            copy_corners(old.corner_normals, mesh.corner_normals);
        }
        for (; piece != end && piece->face == f; ++piece) {
            if (!bisection.is_cut(f))
                continue;
            add_face(f, piece->vertices);
            for (std::size_t k = 0; k < 3 && !old.corner_uvs.empty(); ++k)
                mesh.corner_uvs.emplace_back(blended(
                    piece->weights[k], [&](int i) { return Vec2d(old.corner_uvs[piece->corners[std::size_t(i)]]); }));
            for (std::size_t k = 0; k < 3 && !old.corner_normals.empty(); ++k)
                mesh.corner_normals.push_back(unit_or_zero(Vec3(blended(piece->weights[k], [&](int i) {
                    return Vec3d(old.corner_normals[piece->corners[std::size_t(i)]]);
                }))));
        }
    }
}

void replace_source(Mesh& mesh, const Mesh& old, const Bisection& bisection) {
    mesh.source.reset();
    if (const auto* ply = dynamic_cast<const PlyDocument*>(old.source.get())) {
        const PlyElement *vertices = ply->find("vertex"), *faces = ply->find("face");
        if (vertices && vertices->count == old.vertex_count() && faces && faces->count == old.face_count())
            mesh.source = interpolated_document(*ply, old, mesh, bisection);
        else
            mesh.warnings.push_back("lost by tessellation: other properties of the file, because its vertices and "
                                    "faces no longer match the mesh");
    } else if (old.source) {
        for (const std::string& content : old.source->contents())
            mesh.warnings.push_back("lost by tessellation: " + content);
    }
}

Mesh result_of(const Mesh& mesh, const Bisection& bisection) {
    Mesh result = mesh;
    if (bisection.added().empty())
        return result;
    add_vertices(result, bisection);
    replace_faces(result, mesh, bisection);
    replace_source(result, mesh, bisection);
    return result;
}

}

Mesh tessellate(const Mesh& mesh, const TessellateOptions& options) {
    check_length(options.longest, "longest");
    if (options.longest == 0.0)
        return mesh;
    Bisection bisection(mesh, options.longest);
    const double length = length_that_fits(bisection, options.longest, face_limit(mesh, options.most_faces));
    bisection.cut_longer_than(length);
    Mesh result = result_of(mesh, bisection);
    if (length > options.longest)
        result.warnings.push_back(
            fmt::format("edges up to {:.3g} were not split, although {:.3g} was requested: the limit is {} faces",
                        length, options.longest, grouped(options.most_faces)));
    return result;
}

Mesh tessellate(const Mesh& mesh, const SplitPredicate& split, const AdaptiveTessellateOptions& options) {
    check_length(options.shortest, "shortest");
    check_length(options.spacing, "spacing");
    Bisection bisection(mesh, options.shortest);
    AdaptiveTessellateOptions limited = options;
    limited.most_faces = face_limit(mesh, options.most_faces);
    const bool all = cut_where(bisection, mesh, split, limited);
    Mesh result = result_of(mesh, bisection);
    if (!all)
        result.warnings.push_back(
            fmt::format("some edges were not split although their values vary: the limit is {} faces",
                        grouped(options.most_faces)));
    return result;
}

}
