#include "alcove/mesh/formats/text_scanner.h"

#include <algorithm>

namespace alcove {

std::optional<double> non_finite_number(std::string_view token) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const bool negative = token.starts_with('-');
    if (negative || token.starts_with('+'))
        token.remove_prefix(1);
    const double infinite = negative ? -infinity : infinity;
    if (token == "\u221e")
        return infinite;
    if (token.size() < 3 || token[0] != '1' || (token[1] != '.' && token[1] != ',') ||
        (token[2] != '#' && token[2] != '$'))
        return {};
    const std::string_view rest = token.substr(3);
    const bool is_spelled = std::all_of(rest.begin(), rest.end(), [](char c) {
        return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == 'e' || c == '+' || c == '-';
    });
    if (!is_spelled || (token[2] == '#' && rest.empty()))
        return {};
    return rest.starts_with("INF") ? infinite : std::numeric_limits<double>::quiet_NaN();
}

}
