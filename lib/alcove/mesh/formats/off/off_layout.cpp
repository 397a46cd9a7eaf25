#include "alcove/mesh/formats/off/off_layout.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <compare>

namespace alcove {
namespace {

bool starts_with_any_case(std::string_view text, std::string_view upper_case) {
    return text.size() >= upper_case.size() && std::equal(upper_case.begin(), upper_case.end(), text.begin(),
                                                          [](char a, char b) { return a == std::toupper(b); });
}

std::size_t width_of(OffGroup group, std::size_t color_components) {
    return group == OffGroup::normal ? 3 : group == OffGroup::uv ? 2 : color_components;
}

/// How well the numbers fit an order of the groups. Earlier members count more than later ones.
struct Fit {
    bool colors_in_range = true;
    std::size_t unit_normals = 0, uvs_in_texture = 0, opaque_colors = 0;
    auto operator<=>(const Fit&) const = default;
};

bool is_fraction(double value) {
    return value >= 0.0 && value <= 1.0;
}

/// Whether numbers can be colours: all from 0 to 1, or all whole and from 0 to 255.
class ColorRange {
  public:
    void add(double value) {
        fractions_ &= is_fraction(value);
        bytes_ &= value >= 0.0 && value <= 255.0 && value == std::floor(value);
    }
    bool holds() const { return fractions_ || bytes_; }

  private:
    bool fractions_ = true, bytes_ = true;
};

Fit fit_of(const OffLayout& layout, std::span<const double> rows, std::size_t color_components) {
    Fit fit;
    ColorRange range;
    const std::size_t width = layout.width(color_components);
    for (; rows.size() >= width; rows = rows.subspan(width)) {
        std::span<const double> rest = rows.subspan(layout.weights ? 4 : 3);
        for (const OffGroup group : layout.groups) {
            const std::span<const double> values = rest.first(width_of(group, color_components));
            rest = rest.subspan(values.size());
            if (group == OffGroup::color) {
                for (const double value : values)
                    range.add(value);
                fit.opaque_colors += values.size() == 4 && (values[3] == 1.0 || values[3] == 255.0);
            } else if (group == OffGroup::normal) {
                constexpr double rounding = 0.02;
                fit.unit_normals += std::abs(std::hypot(values[0], values[1], values[2]) - 1.0) < rounding;
            } else {
                fit.uvs_in_texture += is_fraction(values[0]) && is_fraction(values[1]);
            }
        }
    }
    fit.colors_in_range = range.holds();
    if (layout.is_standard)
        fit.opaque_colors = 0; // too weak a reason to leave the order of the format
    return fit;
}

}

bool OffLayout::has(OffGroup group) const {
    return std::find(groups.begin(), groups.end(), group) != groups.end();
}

std::size_t OffLayout::width(std::size_t color_components) const {
    std::size_t width = weights ? 4 : 3;
    for (const OffGroup group : groups)
        width += width_of(group, color_components);
    return width;
}

std::string OffLayout::columns(std::size_t color_components) const {
    std::string text = weights ? "x y z w" : "x y z";
    for (const OffGroup group : groups)
        text += group == OffGroup::normal ? " nx ny nz"
                : group == OffGroup::uv   ? " s t"
                : color_components == 4   ? " r g b a"
                                          : " r g b";
    return text;
}

std::optional<OffLayout> off_layout(std::string_view token) {
    OffLayout layout;
    std::string_view rest = token;
    int last_rank = 0; // place of the last prefix in the order [ST][C][N][4][n]
    const auto take = [&](std::string_view prefix, int rank) {
        layout.is_standard &= rank > last_rank;
        last_rank = rank;
        rest.remove_prefix(prefix.size());
    };
    while (!starts_with_any_case(rest, "OFF")) {
        if (starts_with_any_case(rest, "ST") && !layout.has(OffGroup::uv)) {
            layout.groups.push_back(OffGroup::uv);
            take("ST", 1);
        } else if (starts_with_any_case(rest, "C") && !layout.has(OffGroup::color)) {
            layout.groups.push_back(OffGroup::color);
            take("C", 2);
        } else if (rest.starts_with("nOFF")) {
            layout.dimension = true;
            take("n", 5);
        } else if (starts_with_any_case(rest, "N") && !layout.has(OffGroup::normal)) {
            layout.groups.push_back(OffGroup::normal);
            take("N", 3);
        } else if (rest.starts_with("4") && !layout.weights) {
            layout.weights = true;
            take("4", 4);
        } else {
            return {};
        }
    }
    rest.remove_prefix(3);
    if (!rest.empty() && std::isdigit(static_cast<unsigned char>(rest[0])) == 0)
        return {};
    layout.keyword = token.substr(0, token.size() - rest.size());
    std::sort(layout.groups.begin(), layout.groups.end());
    // Programs that write NC... store colours first.
    if (!layout.is_standard && layout.has(OffGroup::normal) && layout.has(OffGroup::color))
        std::swap(layout.groups[0], layout.groups[1]);
    return layout;
}

void choose_order(OffLayout& layout, std::span<const double> rows, std::size_t color_components) {
    std::vector<OffGroup> best = layout.groups;
    Fit best_fit = fit_of(layout, rows, color_components);
    std::sort(layout.groups.begin(), layout.groups.end());
    do {
        if (const Fit fit = fit_of(layout, rows, color_components); fit > best_fit) {
            best = layout.groups;
            best_fit = fit;
        }
    } while (std::next_permutation(layout.groups.begin(), layout.groups.end()));
    layout.groups = std::move(best);
}

}
