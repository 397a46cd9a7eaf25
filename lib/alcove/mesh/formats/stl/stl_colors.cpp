#include "alcove/mesh/formats/stl/stl_colors.h"

#include "alcove/base/detail/messages.h"

#include <algorithm>
#include <array>
#include <optional>

namespace alcove {
namespace {

constexpr std::uint16_t top_bit = 0x8000;

/// The components in the order of the bits, from the lowest.
std::array<std::uint8_t, 3> components_of(std::uint16_t attribute) {
    const auto byte = [&](int shift) { return static_cast<std::uint8_t>(((attribute >> shift & 31) * 255 + 15) / 31); };
    return {byte(0), byte(5), byte(10)};
}

/// The colour of the whole part in the header of Magics.
std::optional<Color> color_of_part(std::string_view header) {
    constexpr std::string_view keyword = "COLOR=";
    const std::size_t at = header.find(keyword);
    if (at == std::string_view::npos || header.size() - at < keyword.size() + 4)
        return {};
    Color color;
    std::copy_n(header.begin() + static_cast<std::ptrdiff_t>(at + keyword.size()), 4, color.begin());
    return color;
}

std::vector<Color> magics_colors(const Color& part, std::span<const std::uint16_t> attributes, bool all_zero) {
    std::vector<Color> colors;
    colors.reserve(attributes.size());
    for (const std::uint16_t attribute : attributes) {
        const auto [red, green, blue] = components_of(attribute);
        colors.push_back(all_zero || attribute & top_bit ? part : Color{red, green, blue, 255});
    }
    return colors;
}

std::vector<Color> viscam_colors(std::span<const std::uint16_t> attributes) {
    std::vector<Color> colors;
    colors.reserve(attributes.size());
    for (const std::uint16_t attribute : attributes) {
        const auto [blue, green, red] = components_of(attribute);
        colors.push_back(attribute & top_bit ? Color{red, green, blue, 255} : Color{170, 170, 170, 255});
    }
    return colors;
}

}

std::vector<Color> stl_colors(std::string_view header, std::span<const std::uint16_t> attributes,
                              std::vector<std::string>& warnings) {
    const auto count = [&](auto&& is) {
        return static_cast<std::size_t>(std::count_if(attributes.begin(), attributes.end(), is));
    };
    const std::size_t zero = count([](std::uint16_t a) { return a == 0; });
    if (const std::optional<Color> part = color_of_part(header))
        return magics_colors(*part, attributes, zero == attributes.size());
    const std::size_t valid = count([](std::uint16_t a) { return (a & top_bit) != 0; });
    const std::size_t other = attributes.size() - valid - zero;
    if (other > 0)
        warnings.push_back(counted(other, "facet has", "facets have") +
                           " attribute bytes that are not marked as a colour; left out");
    if (valid == 0)
        return {};
    if (valid < attributes.size())
        warnings.push_back(counted(attributes.size() - valid, "facet has", "facets have") +
                           " no colour, unlike others; grey is used");
    return viscam_colors(attributes);
}

}
