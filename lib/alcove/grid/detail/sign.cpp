#include "alcove/grid/detail/sign.h"

#include "alcove/base/detail/memory.h"
#include "alcove/base/detail/messages.h"
#include "alcove/base/parallel.h"
#include "alcove/mesh/detail/edge_table.h"
#include "alcove/mesh/detail/weld.h"
#include "alcove/mesh/diagnose.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

namespace alcove {
namespace {

// A part counts as hidden inside other parts if less than this share of it bounds the solid.
constexpr double min_bounding = 0.05;
// Largest share of the surface that may bound regions of negative winding number: in a solid these walls would vanish.
constexpr double max_in_air = 0.01;

void warn_of_orientation(const Closedness& surface, std::vector<std::string>& warnings) {
    if (surface.flipped_edges > 0)
        warnings.push_back(
            fmt::format("at {} the neighbouring faces have opposite orientations: vertices there are shaded "
                        "on the side that their normals happen to point to; orient the faces consistently first",
                        counted(surface.flipped_edges, "edge", "edges")));
    if (surface.inverted_components > 0)
        warnings.push_back(fmt::format(
            "{} of {} parts {}", grouped(surface.inverted_components), grouped(surface.components),
            surface.inverted_components == 1 ? "faces inward, so its AO is that of its inside. This is right for the "
                                               "wall of a cavity; otherwise flip its faces"
                                             : "face inward, so their AO is that of their inside. This is right for "
                                               "the walls of cavities; otherwise flip their faces"));
}

/// Parts of the surface that are connected by shared vertices. Coincident vertices are not joined.
DisjointSets parts_as_indexed(std::size_t vertices, std::span<const Triangle> triangles) {
    DisjointSets parts(vertices);
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
        if (!parts.surely_joined(a, b))
            parts.join(a, b);
    };
    for (const Triangle& t : triangles) {
        join(t[0], t[1]);
        join(t[0], t[2]);
    }
    return parts;
}

/// Whether some part of the surface almost nowhere separates inside from outside.
bool buries_a_part(const WindingColumns& columns, std::span<const Triangle> triangles, DisjointSets& parts) {
    struct Crossings {
        std::size_t all = 0, bounding = 0;
    };
    std::vector<Crossings> counts = huge_vector<Crossings>(parts.size());
    columns.for_each_crossing([&](std::uint32_t triangle, bool bounding) {
        Crossings& part = counts[parts.find(triangles[triangle][0])];
        ++part.all;
        part.bounding += bounding;
    });
    return std::any_of(counts.begin(), counts.end(), [](const Crossings& part) {
        return static_cast<double>(part.bounding) < min_bounding * static_cast<double>(part.all);
    });
}

/// Whether some part of a closed surface has a negative volume.
bool inverts_a_part(std::span<const Vec3d> positions, std::span<const Triangle> triangles, DisjointSets& parts) {
    std::vector<double> volumes = huge_vector<double>(parts.size());
    const Vec3d centre = positions[triangles[0][0]];
    for (const auto& [a, b, c] : triangles)
        volumes[parts.find(a)] +=
            glm::dot(positions[a] - centre, glm::cross(positions[b] - centre, positions[c] - centre));
    return std::any_of(volumes.begin(), volumes.end(), [](double volume) { return volume < 0.0; });
}

}

bool balanced(std::span<const Triangle> triangles) {
    const auto edge_hash = [](std::uint64_t a, std::uint64_t b) { // finalizer of MurmurHash3 (Appleby 2011)
        std::uint64_t x = a << 32 | b;
        x = (x ^ (x >> 33)) * 0xff51afd7ed558ccdULL;
        x = (x ^ (x >> 33)) * 0xc4ceb9fe1a85ec53ULL;
        return x ^ (x >> 33);
    };
    std::atomic<std::uint64_t> total{0};
    parallel_for(triangles.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
        std::uint64_t sum = 0;
        for (const Triangle& t : triangles.subspan(begin, end - begin))
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = t[k], b = t[(k + 1) % 3];
                const std::uint64_t hash = edge_hash(std::min(a, b), std::max(a, b));
                sum += a < b ? hash : a > b ? 0 - hash : 0;
            }
        total += sum;
    });
    return total == 0;
}

Sign choose_sign(SignChoice choice, const Mesh& mesh, const WindingColumns& columns, bool is_balanced,
                 std::span<const Vec3d> positions, std::span<const Triangle> triangles,
                 std::vector<std::string>& warnings) {
    const double leaking = columns.leaking();
    const bool overlapping = columns.overlapping();
    // Each part consists of parts as indexed, which are found faster: if none of these is hidden or inverted, no part
    // is.
    const auto no_part_is_wrong = [&] {
        DisjointSets parts = parts_as_indexed(positions.size(), triangles);
        return !buries_a_part(columns, triangles, parts) && !inverts_a_part(positions, triangles, parts);
    };
    const bool sound = leaking == 0.0 && is_balanced && (!overlapping || no_part_is_wrong());
    const Closedness shape = sound ? Closedness{} : closedness(mesh);
    warn_of_orientation(shape, warnings);
    if (choice == SignChoice::sheet)
        return Sign::sheet;
    if (choice == SignChoice::solid) {
        if (leaking > 0.0)
            warnings.push_back(
                fmt::format("the mesh is treated as a solid as requested, but {:.1f} % of the lines through it "
                            "pass through a hole: use --sign auto",
                            100.0 * leaking));
        return Sign::solid;
    }
    if (columns.hollow())
        return Sign::sheet;
    if (!sound && (!shape.closed() || leaking > 0.0))
        return Sign::sheet;
    if (!overlapping)
        return Sign::solid;
    if (columns.in_air() > max_in_air)
        return Sign::sheet;
    if (sound)
        return Sign::solid;
    DisjointSets parts = parts_as_indexed(positions.size(), triangles);
    const std::vector<std::uint32_t> first = weld(positions);
    for (std::uint32_t v = 0; v < first.size(); ++v)
        parts.join(v, first[v]);
    return buries_a_part(columns, triangles, parts) ? Sign::sheet : Sign::solid;
}

}
