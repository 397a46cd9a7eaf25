#include "alcove/base/detail/messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace alcove {

std::string in_quotes(std::string_view text) {
    constexpr std::size_t longest = 40;
    std::string result = "'";
    for (const char c : text.substr(0, longest))
        result += c >= ' ' && c <= '~' ? c : '?';
    return result + (text.size() > longest ? "...'" : "'");
}

std::string in_one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, '?');
    return text;
}

std::string grouped(std::size_t count) {
    std::string digits = std::to_string(count);
    for (std::ptrdiff_t at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0; at -= 3)
        digits.insert(static_cast<std::size_t>(at), 1, ',');
    return digits;
}

std::string rounded(double number, int digits) {
    constexpr double largest = 1e15;
    if (!(number > 1.0 / largest && number < largest))
        return fmt::format("{:.{}g}", number, digits);
    const int after_point = digits - 1 - static_cast<int>(std::floor(std::log10(number)));
    if (after_point <= 0) {
        const double unit = std::pow(10.0, -after_point);
        return grouped(static_cast<std::size_t>(std::round(number / unit) * unit));
    }
    std::string text = fmt::format("{:.{}f}", number, after_point);
    text.erase(text.find_last_not_of('0') + 1);
    return text.ends_with('.') ? text.substr(0, text.size() - 1) : text;
}

std::string counted(std::size_t count, std::string_view singular, std::string_view plural) {
    return grouped(count) + " " + std::string(count == 1 ? singular : plural);
}

}
