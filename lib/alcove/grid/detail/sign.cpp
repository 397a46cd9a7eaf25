#include "alcove/grid/detail/sign.h"

#include "alcove/base/parallel.h"
#include "alcove/mesh/detail/edge_table.h"
#include "alcove/mesh/detail/weld.h"
#include "alcove/mesh/diagnose.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

namespace alcove {
namespace {

// A part is buried if less than this share of it bounds the solid.
constexpr double min_bounding = 0.05;
// Walls around regions of negative winding numbers would vanish from a solid.
constexpr double max_in_air = 0.01;

void warn_of_orientation(const Closedness& surface, std::vector<std::string>& warnings) {
    if (surface.flipped_edges > 0)
        warnings.push_back(
            fmt::format("at {} edges the neighbouring faces have opposite orientations: vertices there are shaded "
                        "on the side that their normals happen to point to; orient the faces consistently first",
                        surface.flipped_edges));
    if (surface.inverted_components > 0)
        warnings.push_back(
            fmt::format("{} of {} parts face inward and get the occlusion of their inside: correct for the "
                        "wall of a cavity, otherwise flip their faces first",
                        surface.inverted_components, surface.components));
}

/// Whether some connected part of the surface almost nowhere separates inside from outside.
bool buries_a_part(const WindingColumns& columns, std::span<const Vec3d> positions,
                   std::span<const Triangle> triangles) {
    const std::vector<std::uint32_t> joined = weld(positions);
    DisjointSets parts(joined.size());
    for (const Triangle& t : triangles)
        for (const std::uint32_t v : t)
            parts.join(joined[t[0]], joined[v]);
    struct Crossings {
        std::size_t all = 0, bounding = 0;
    };
    std::vector<Crossings> counts(joined.size());
    columns.for_each_crossing([&](std::uint32_t triangle, bool bounding) {
        Crossings& part = counts[parts.find(joined[triangles[triangle][0]])];
        ++part.all;
        part.bounding += bounding;
    });
    return std::any_of(counts.begin(), counts.end(), [](const Crossings& part) {
        return static_cast<double>(part.bounding) < min_bounding * static_cast<double>(part.all);
    });
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

Sign choose_sign(SignChoice choice, const Mesh& mesh, const WindingColumns& columns, std::span<const Vec3d> positions,
                 std::span<const Triangle> triangles, std::vector<std::string>& warnings) {
    const double leaking = columns.leaking();
    const bool overlapping = columns.overlapping();
    const bool sound = leaking == 0.0 && !overlapping && balanced(triangles);
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
    if (sound)
        return Sign::solid;
    if (!shape.closed() || leaking > 0.0)
        return Sign::sheet;
    if (!overlapping)
        return Sign::solid;
    return columns.in_air() > max_in_air || buries_a_part(columns, positions, triangles) ? Sign::sheet : Sign::solid;
}

}
