#include "alcove/bake/detail/gap_warnings.h"

#include "alcove/base/detail/messages.h"
#include "alcove/mesh/detail/gaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace alcove {
namespace {

/// The number of vertices that share their position with a vertex whose normal is slightly different. The surface is
/// smooth there, but the normal of each vertex takes only its own faces into account.
std::size_t faceted_vertices(const Gaps& gaps, std::span<const Surfel> surfels) {
    constexpr float flat = 0.99985f, sharp = 0.766f; // cos 1° and cos 40°
    constexpr std::ptrdiff_t most_compared = 64;     // the work is quadratic in the number of vertices at a position
    std::vector<std::array<std::uint32_t, 2>> by_place;
    for (const auto& [v, first] : gaps.repeated) {
        by_place.push_back({first, v});
        by_place.push_back({first, first});
    }
    std::sort(by_place.begin(), by_place.end());
    by_place.erase(std::unique(by_place.begin(), by_place.end()), by_place.end());
    std::size_t count = 0;
    for (auto begin = by_place.begin(), end = begin; begin != by_place.end(); begin = end) {
        end = std::find_if(begin, by_place.end(), [&](const auto& vertex) { return vertex[0] != (*begin)[0]; });
        const auto last_compared = begin + std::min(end - begin, most_compared);
        count += static_cast<std::size_t>(std::count_if(begin, end, [&](const auto& vertex) {
            return std::any_of(begin, last_compared, [&](const auto& other) {
                const float cosine = glm::dot(surfels[vertex[1]].normal, surfels[other[1]].normal);
                return cosine > sharp && cosine < flat;
            });
        }));
    }
    return count;
}

}

std::vector<std::string> gap_warnings(const Mesh& mesh, std::span<const Triangle> triangles,
                                      std::span<const Surfel> surfels, bool own_normals) {
    std::vector<std::string> warnings;
    const Gaps gaps = find_gaps(mesh, triangles);
    if (gaps.closable > 0)
        warnings.push_back(gaps.advice());
    if (const std::size_t faceted = own_normals ? 0 : faceted_vertices(gaps, surfels); faceted > 0)
        warnings.push_back(fmt::format(
            "{}, so a smooth surface is shaded per face there: add --weld 0.0001% to join "
            "them, or export normals",
            counted(faceted, "vertex shares its position with others", "vertices share positions with others")));
    return warnings;
}

}
