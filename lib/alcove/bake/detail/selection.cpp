#include "alcove/bake/detail/selection.h"

#include "alcove/base/detail/edit_distance.h"
#include "alcove/base/detail/messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace alcove {
namespace {

bool has_name_like(const FaceGroup& group, std::string_view pattern) {
    return std::any_of(group.names.begin(), group.names.end(),
                       [&](const std::string& name) { return matches(name, pattern); });
}

/// Calls f(group) for all groups that a pattern matches. \throw InputError if a pattern matches none.
template <class F>
void for_each_match(const Mesh& mesh, const std::vector<std::string>& patterns, std::string_view option, F&& f) {
    for (const std::string& pattern : patterns) {
        bool found = false;
        for (std::size_t g = 0; g < mesh.groups.size(); ++g)
            if (has_name_like(mesh.groups[g], pattern)) {
                f(g);
                found = true;
            }
        if (found)
            continue;
        std::set<std::string> names;
        for (const FaceGroup& group : mesh.groups)
            names.insert(group.names.begin(), group.names.end());
        if (names.empty())
            throw InputError(
                fmt::format("{} {}: the mesh has no named parts; only glTF nodes, meshes and materials, and "
                            "OBJ objects, groups and materials have names",
                            option, in_quotes(pattern)));
        const std::string nearest = nearest_name(pattern, {names.begin(), names.end()});
        throw InputError(fmt::format("{} {} matches no name; {} {}", option, in_quotes(pattern),
                                     nearest.empty() ? "one of the names is" : "did you mean",
                                     in_quotes(nearest.empty() ? *names.begin() : nearest)) +
                         (nearest.empty() ? "" : "?"));
    }
}

}

bool matches(std::string_view name, std::string_view pattern) {
    // Remember the last *, and let it match one more character after each failure.
    std::size_t n = 0, p = 0, star = std::string_view::npos, resume = 0;
    while (n < name.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            star = p++;
            resume = n;
        } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
            ++p;
            ++n;
        } else if (star != std::string_view::npos) {
            p = star + 1;
            n = ++resume;
        } else {
            return false;
        }
    }
    return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

SelectedFaces select_faces(const Mesh& mesh, const FaceSelection& selection) {
    struct Use {
        std::uint8_t baked, occluding;
    };
    std::vector<Use> uses(mesh.groups.size(), {selection.only.empty(), 1});
    for_each_match(mesh, selection.only, "--only", [&](std::size_t g) { uses[g].baked = 1; });
    for_each_match(mesh, selection.exclude, "--exclude", [&](std::size_t g) { uses[g] = {0, 0}; });
    for_each_match(mesh, selection.no_occlude, "--no-occlude", [&](std::size_t g) { uses[g].occluding = 0; });
    SelectedFaces selected{std::vector<std::uint8_t>(mesh.face_count(), selection.only.empty()),
                           std::vector<std::uint8_t>(mesh.face_count(), 1)};
    for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
        if (selection.opaque_only && mesh.groups[g].see_through)
            uses[g].occluding = 0;
        for (std::size_t f = mesh.groups[g].first_face; f < mesh.group_end(g); ++f) {
            selected.baked[f] = uses[g].baked;
            selected.occluding[f] = uses[g].occluding;
        }
    }
    const auto any = [](const std::vector<std::uint8_t>& faces) {
        return std::find(faces.begin(), faces.end(), 1) != faces.end();
    };
    if (!any(selected.baked))
        throw InputError("--exclude leaves no face to bake: exclude less, or name other parts with --only");
    return selected;
}

Mesh remaining(const Mesh& mesh, const SelectedFaces& selected) {
    Mesh rest;
    rest.name = mesh.name;
    rest.format = mesh.format;
    rest.source = mesh.source;
    rest.positions = mesh.positions;
    rest.normals = mesh.normals;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        if (!selected.baked[f] && !selected.occluding[f])
            continue;
        rest.add_face(mesh.face(f));
        if (!mesh.corner_normals.empty())
            rest.corner_normals.insert(rest.corner_normals.end(), mesh.corner_normals.begin() + mesh.face_begin[f],
                                       mesh.corner_normals.begin() + mesh.face_begin[f + 1]);
    }
    return rest;
}

}
