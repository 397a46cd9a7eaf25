#include "alcove/mesh/diagnose.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/mesh/detail/edge_table.h"
#include "alcove/mesh/detail/gaps.h"
#include "alcove/mesh/detail/weld.h"
#include "alcove/mesh/normals.h"
#include "alcove/mesh/triangulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace alcove {
namespace {

/// The mesh as a surface, which both closedness() and diagnose() examine.
struct Surface {
    explicit Surface(const Mesh& mesh)
        : joined(weld(mesh.positions)), faces(sound_faces(mesh, joined)), edges(faces, mesh.vertex_count()) {}

    std::vector<std::uint32_t> joined;
    SoundFaces faces;
    EdgeTable edges;
};

std::size_t forward_uses(std::span<const EdgeUse> uses) {
    std::size_t count = 0;
    for (const EdgeUse& use : uses)
        count += use.forward;
    return count;
}

/// The sum of the signed volumes between the centre of the mesh and each face, in units of the diagonal cubed. A face
/// consists of triangles between its edges and the mean of its corners, so that the result does not depend on which
/// corner is the first.
struct Volume {
    double sum = 0.0;
    double bound = 0.0; // upper bound of the absolute sum

    void add(const Mesh& mesh, const Frame& frame, std::span<const std::uint32_t> face) {
        const double scale = 1.0 / frame.diagonal;
        const auto at = [&](std::uint32_t v) { return scale * (mesh.positions[v] - frame.center); };
        const Vec3d first = at(face[0]);
        Vec3d side = at(face[1]) - first, total = side, normal(0.0);
        double areas = 0.0;
        for (std::size_t i = 2; i < face.size(); ++i) {
            const Vec3d next = at(face[i]) - first;
            normal += glm::cross(side, next);
            areas += std::sqrt(glm::dot(side, side) * glm::dot(next, next));
            total += next;
            side = next;
        }
        const Vec3d mean = first + total / static_cast<double>(face.size());
        sum += glm::dot(mean, normal) / 6.0;
        bound += glm::length(mean) * areas / 6.0;
    }
    /// Ignores signs that are due to rounding: a folded sheet encloses no volume.
    bool negative() const { return sum < -1e-12 * bound; }
};

Closedness closedness_of(const Mesh& mesh, const Surface& surface) {
    const SoundFaces& faces = surface.faces;
    Closedness result;
    DisjointSets components(faces.count());
    std::vector<char> open = huge_vector<char>(faces.count());
    surface.edges.for_each_edge([&](std::span<const EdgeUse> uses) {
        const std::size_t forward = forward_uses(uses);
        const bool unbalanced = 2 * forward != uses.size();
        const std::uint32_t face = faces.face_of[uses[0].corner];
        ++result.edges;
        result.open_edges += uses.size() == 1;
        result.non_manifold_edges += uses.size() >= 3;
        result.flipped_edges += uses.size() == 2 && unbalanced;
        result.odd_edges += uses.size() % 2;
        result.unbalanced_edges += unbalanced;
        if (unbalanced)
            open[face] = 1;
        for (const EdgeUse& use : uses.subspan(1))
            if (const std::uint32_t other = faces.face_of[use.corner]; !components.surely_joined(face, other))
                components.join(face, other);
    });

    const Frame frame = frame_of(mesh.box());
    struct Component {
        Volume volume;
        bool open = false;
    };
    std::vector<Component> parts;
    std::vector<std::uint32_t> part_of = huge_vector<std::uint32_t>(faces.count());
    for (std::uint32_t f = 0; f < faces.count(); ++f) {
        const std::uint32_t first = components.find(f); // the smallest of its set, so the set has a number
        if (first == f)
            parts.emplace_back();
        part_of[f] = first == f ? static_cast<std::uint32_t>(parts.size() - 1) : part_of[first];
        Component& part = parts[part_of[f]];
        part.open = part.open || open[f];
    }
    for (std::uint32_t f = 0; f < faces.count(); ++f)
        if (Component& part = parts[part_of[f]]; !part.open)
            part.volume.add(mesh, frame, faces.face(f));
    double volume = 0.0;
    result.components = parts.size();
    for (const Component& part : parts)
        if (!part.open) {
            ++result.closed_components;
            result.inverted_components += part.volume.negative();
            volume += part.volume.sum;
        }
    result.signed_volume = volume * frame.diagonal * frame.diagonal * frame.diagonal;
    return result;
}

std::size_t boundary_edges_as_indexed(const Mesh& mesh) {
    std::vector<std::uint32_t> separate(mesh.vertex_count());
    std::iota(separate.begin(), separate.end(), 0u);
    const SoundFaces faces = sound_faces(mesh, separate);
    std::size_t count = 0;
    EdgeTable(faces, mesh.vertex_count()).for_each_edge([&](std::span<const EdgeUse> uses) {
        count += uses.size() == 1;
    });
    return count;
}

/// Counts non-manifold vertices and boundary loops. Two corners at a vertex belong to the same fan if their faces share
/// an edge there.
void examine_fans(const Mesh& mesh, const Surface& surface, Diagnosis& result) {
    const SoundFaces& faces = surface.faces;
    DisjointSets fans(faces.corners.size());
    std::vector<std::uint32_t> open_corners; // where open edges start
    surface.edges.for_each_edge([&](std::span<const EdgeUse> uses) {
        const auto low = [&](const EdgeUse& u) { return u.forward ? u.corner : faces.next(u.corner); };
        const auto high = [&](const EdgeUse& u) { return u.forward ? faces.next(u.corner) : u.corner; };
        for (const EdgeUse& use : uses.subspan(1)) {
            fans.join(low(uses[0]), low(use));
            fans.join(high(uses[0]), high(use));
        }
        if (uses.size() == 1)
            open_corners.push_back(uses[0].corner);
    });
    std::vector<std::uint32_t> fans_of(mesh.vertex_count(), 0);
    for (std::uint32_t corner = 0; corner < faces.corners.size(); ++corner)
        if (fans.find(corner) == corner)
            result.non_manifold_vertices += ++fans_of[faces.corners[corner]] == 2;

    // Open edges that meet in a fan are neighbours in a boundary loop.
    for (const std::uint32_t corner : open_corners)
        fans.join(corner, faces.next(corner));
    std::vector<std::uint32_t> loops;
    loops.reserve(open_corners.size());
    for (const std::uint32_t corner : open_corners)
        loops.push_back(fans.find(corner));
    std::sort(loops.begin(), loops.end());
    result.boundary_loops = static_cast<std::size_t>(std::unique(loops.begin(), loops.end()) - loops.begin());
}

std::size_t faces_without_area(const Mesh& mesh, const SoundFaces& faces) {
    const double scale = exact_scale(mesh);
    std::size_t count = 0;
    for (std::size_t f = 0; f < faces.count(); ++f) {
        const auto face = faces.face(f);
        const auto at = [&](std::uint32_t v) { return scale * (mesh.positions[v] - mesh.positions[face[0]]); };
        Vec3d normal(0.0), a = at(face[1]);
        double bound = 0.0;
        for (std::size_t i = 2; i < face.size(); ++i) {
            const Vec3d b = at(face[i]);
            normal += glm::cross(a, b);
            bound += glm::length(a) * glm::length(b);
            a = b;
        }
        count += glm::length(normal) <= flat_sine * bound;
    }
    return count;
}

std::size_t count_duplicates(const SoundFaces& faces) {
    const auto vertices_of = [&](std::uint32_t f) {
        const auto face = faces.face(f);
        std::vector<std::uint32_t> sorted(face.begin(), face.end());
        std::sort(sorted.begin(), sorted.end());
        return sorted;
    };
    // The sum of the hashes of a face does not depend on the order of its vertices. Only faces with equal sums are
    // compared.
    struct Entry {
        std::uint64_t sum;
        std::uint32_t face;
    };
    std::vector<Entry> entries(faces.count());
    for (std::uint32_t f = 0; f < faces.count(); ++f) {
        std::uint64_t sum = 0;
        for (const std::uint32_t v : faces.face(f)) {
            std::uint64_t x = (v + 1ULL) * 0x9e3779b97f4a7c15ULL;
            x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
            sum += x ^ (x >> 27);
        }
        entries[f] = {sum, f};
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.sum < b.sum; });
    std::size_t count = 0;
    for (std::size_t at = 0, after = 0; at < entries.size(); at = after) {
        while (after < entries.size() && entries[after].sum == entries[at].sum)
            ++after;
        if (after - at < 2)
            continue;
        std::vector<std::vector<std::uint32_t>> sets;
        for (std::size_t i = at; i < after; ++i)
            sets.push_back(vertices_of(entries[i].face));
        std::sort(sets.begin(), sets.end());
        count += static_cast<std::size_t>(sets.end() - std::unique(sets.begin(), sets.end()));
    }
    return count;
}

void count_elements(const Mesh& mesh, const Surface& surface, Diagnosis& result) {
    result.vertices = mesh.vertex_count();
    result.faces = mesh.face_count();
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const std::size_t corners = mesh.face(f).size();
        result.triangles += corners == 3;
        result.quads += corners == 4;
        result.larger_polygons += corners > 4;
    }
    std::vector<char> referenced(mesh.vertex_count(), 0);
    for (const std::uint32_t v : mesh.corners)
        referenced[v] = 1;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        result.unreferenced_vertices += referenced[v] == 0;
        result.non_finite_vertices += !is_finite(mesh.positions[v]);
        result.coincident_vertices += surface.joined[v] != v;
    }
}

}

Closedness closedness(const Mesh& mesh) {
    return closedness_of(mesh, Surface(mesh));
}

Diagnosis diagnose(const Mesh& mesh) {
    const Surface surface(mesh);
    Diagnosis result{closedness_of(mesh, surface)};
    count_elements(mesh, surface, result);
    result.boundary_edges = result.coincident_vertices > 0 ? boundary_edges_as_indexed(mesh) : result.open_edges;
    examine_fans(mesh, surface, result);
    result.degenerate_faces = surface.faces.collapsed + faces_without_area(mesh, surface.faces);
    result.duplicate_faces = count_duplicates(surface.faces);
    const Gaps gaps = find_gaps(mesh, triangulate(mesh).triangles);
    result.closable_edges = gaps.closable;
    result.closing_distance = gaps.distance;
    return result;
}

std::vector<std::string> describe(const Diagnosis& d) {
    std::vector<std::string> lines;
    const auto say = [&](std::size_t count, std::string_view one, std::string_view many, std::string_view meaning,
                         std::string_view meaning_of_many = {}) {
        if (count > 0)
            lines.push_back(fmt::format("{}: {}", counted(count, one, many),
                                        count == 1 || meaning_of_many.empty() ? meaning : meaning_of_many));
    };
    if (d.components == 0)
        lines.push_back("no face spans a surface");
    else if (d.closed())
        lines.push_back(d.components == 1 ? "closed, with faces oriented consistently"
                                          : fmt::format("closed in {} parts, each with faces oriented consistently",
                                                        grouped(d.components)));
    else if (d.open_edges > 0)
        lines.push_back(fmt::format("not closed, {} around {}: distances cannot distinguish inside from outside; fill "
                                    "the holes for signed distances",
                                    counted(d.open_edges, "open edge", "open edges"),
                                    counted(d.boundary_loops, "hole or boundary", "holes or boundaries")));
    else if (d.watertight())
        lines.push_back("without holes, but the faces are not oriented consistently");
    else
        lines.push_back(
            fmt::format("not closed: {} where a face ends on other faces", counted(d.odd_edges, "edge", "edges")));
    say(d.flipped_edges, "flipped edge", "flipped edges",
        "neighbouring faces have opposite orientations and vertex normals cancel there; orient the faces "
        "consistently");
    say(d.inverted_components, "part inside out", "parts inside out",
        "normals point into the solid; flip its faces unless it is the wall of a cavity",
        "normals point into the solid; flip their faces unless they are walls of cavities");
    say(d.non_manifold_edges, "non-manifold edge", "non-manifold edges",
        "three or more faces meet; harmless for distances, but normals average all of them");
    say(d.non_manifold_vertices, "non-manifold vertex", "non-manifold vertices",
        "surfaces touch at a point; normals average both");
    say(d.seam_edges(), "seam edge", "seam edges",
        "closed if coincident vertices are merged; face normals are discontinuous there; provide "
        "normals, or join the vertices with --weld 0.0001%");
    if (const Gaps gaps{{}, d.closable_edges, d.closing_distance}; d.closable_edges > 0)
        lines.push_back(gaps.advice());
    say(d.degenerate_faces, "face without area", "faces without area", "it is ignored", "they are ignored");
    say(d.duplicate_faces, "duplicate face", "duplicate faces", "remove it: it may swap inside and outside",
        "remove them: they may swap inside and outside");
    say(d.unreferenced_vertices, "vertex in no face", "vertices in no face", "it has no normal and gets ao = 1",
        "they have no normal and get ao = 1");
    say(d.non_finite_vertices, "vertex with non-finite coordinates", "vertices with non-finite coordinates",
        "ignored, with its faces", "ignored, with their faces");
    return lines;
}

}
