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
    std::vector<OffGroup> groups; ///< in the order of the values
    bool weights = false, dimension = false;
    std::string_view keyword;
    bool is_standard = true; ///< the prefixes of the keyword are in the order of the format

    bool has(OffGroup group) const;
    /// The number of values of a vertex whose colour has `color_components` components.
    std::size_t width(std::size_t color_components) const;
    /// "x y z nx ny nz r g b a"
    std::string columns(std::size_t color_components) const;
};

/// The layout that a keyword declares, in upper or lower case. Counts may follow it without a blank.
std::optional<OffLayout> off_layout(std::string_view token);

/// Chooses the order of the groups in which colours have the range of colours, normals have length 1 and texture
/// coordinates are in the texture. `rows` holds the numbers of some vertices, one vertex after another. Where several
/// orders fit equally well, the order in `layout` stays.
void choose_order(OffLayout& layout, std::span<const double> rows, std::size_t color_components);

}
