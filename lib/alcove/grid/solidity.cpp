#include "alcove/grid/solidity.h"

#include "alcove/mesh/edge_table.h"
#include "alcove/mesh/weld.h"

#include <fmt/format.h>

#include <algorithm>

namespace alcove {
namespace {

// A part is buried when less than this share of it bounds the solid.
constexpr double least_bounding = 0.05;

/// Whether a connected part of the surface is practically nowhere between inside and outside.
bool buries_a_part(const WindingColumns& columns, const std::vector<Vec3d>& positions,
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
        return static_cast<double>(part.bounding) < least_bounding * static_cast<double>(part.all);
    });
}

}

Sign choose_sign(SignChoice choice, const Closedness& shape, const WindingColumns& columns,
                 const std::vector<Vec3d>& positions, std::span<const Triangle> triangles,
                 std::vector<std::string>& warnings) {
    if (choice == SignChoice::sheet)
        return Sign::sheet;
    const double leaking = columns.leaking();
    if (choice == SignChoice::solid) {
        if (leaking > 0.0)
            warnings.push_back(
                fmt::format("the mesh is taken for a solid as asked, but {:.1f} % of the lines through it "
                            "find a hole: use --sign auto",
                            100.0 * leaking));
        return Sign::solid;
    }
    if (!shape.closed() || leaking > 0.0)
        return Sign::sheet;
    return columns.overlapping() && buries_a_part(columns, positions, triangles) ? Sign::sheet : Sign::solid;
}

}
