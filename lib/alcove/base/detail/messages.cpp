#include "alcove/base/detail/messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace alcove {
namespace {

/// Whether the character is a byte-order mark, a zero-width space, a line separator or a mark of the writing direction.
bool is_invisible(unsigned code) {
    return code == 0xfeff || (code >= 0x200b && code <= 0x200f) || (code >= 0x2028 && code <= 0x202e) ||
           (code >= 0x2060 && code <= 0x2069);
}

/// The length in bytes of the UTF-8 character at the start of `text`; 0 if it is a control character, invisible or
/// invalid.
std::size_t printable_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    if (byte(0) < 0x80)
        return byte(0) >= ' ' && byte(0) != 0x7f;
    if (byte(0) < 0xc2 || byte(0) > 0xf4)
        return 0;
    const std::size_t length = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : 2;
    unsigned code = byte(0) & (0x7fu >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xc0) != 0x80)
            return 0;
        code = code << 6 | (byte(i) & 0x3f);
    }
    constexpr unsigned smallest[] = {0, 0, 0xa0, 0x800, 0x10000}; // U+0080 to U+009F are control characters
    const bool surrogate = code >= 0xd800 && code < 0xe000;
    return code >= smallest[length] && code <= 0x10ffff && !surrogate && !is_invisible(code) ? length : 0;
}

/// Moves the first character of `from` to the end of `to`. If that character must not be printed, removes only its
/// first byte and appends '?'.
void move_character(std::string_view& from, std::string& to) {
    const std::size_t length = printable_length(from);
    to += length > 0 ? from.substr(0, length) : "?";
    from.remove_prefix(std::max<std::size_t>(length, 1));
}

}

std::string in_one_line(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty())
        move_character(text, result);
    return result;
}

std::string in_quotes(std::string_view text) {
    constexpr int longest = 40;
    std::string result = "'";
    for (int characters = 0; !text.empty() && characters < longest; ++characters)
        move_character(text, result);
    return result + (text.empty() ? "'" : "...'");
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

std::string bytes_text(double bytes) {
    constexpr int digits = 3;
    for (const auto& [unit, name] : {std::pair{1e9, " GB"}, {1e6, " MB"}, {1e3, " kB"}})
        if (bytes >= unit)
            return rounded(bytes / unit, digits) + name;
    return rounded(bytes, digits) + " bytes";
}

std::string counted(std::size_t count, std::string_view singular, std::string_view plural) {
    return grouped(count) + " " + std::string(count == 1 ? singular : plural);
}

}
