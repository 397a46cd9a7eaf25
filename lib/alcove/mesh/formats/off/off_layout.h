/// What an OFF file stores for each vertex, and in which order.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alcove {

/// Groups of values after the coordinates, in the order of the format.
enum class OffGroup { normal, color, uv };

struct OffLayout {
    std::vector<OffGroup> groups; ///< in the order in which the file stores them
    bool weights = false, dimension = false;
    std::string_view keyword;
    bool is_standard = true; ///< whether the prefixes of the keyword are in the order of the format

    bool has(OffGroup group) const;
    /// The number of values of a vertex whose colour has `color_components` components.
    std::size_t width(std::size_t color_components) const;
    /// The names of the values of a vertex: "x y z nx ny nz r g b a".
    std::string columns(std::size_t color_components) const;
};

/// The layout that a keyword declares, in upper or lower case. Counts may follow it without a blank.
std::optional<OffLayout> off_layout(std::string_view token);

/// Chooses the order of the groups that fits the numbers best: the one in which colours are in the range of colours,
/// normals have length 1, and texture coordinates lie within the texture. `rows` holds the numbers of some vertices,
/// one vertex after another. If no order fits better than the one in `layout`, that one stays.
void choose_order(OffLayout& layout, std::span<const double> rows, std::size_t color_components);

}
