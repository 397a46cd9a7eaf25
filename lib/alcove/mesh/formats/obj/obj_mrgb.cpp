#include "alcove/mesh/formats/obj/obj_mrgb.h"

#include <algorithm>
#include <charconv>

namespace alcove {
namespace {

constexpr std::string_view blanks = " \t\r";

bool begins_line(std::string_view text, std::size_t at) {
    return at == 0 || text[at - 1] == '\n' || text[at - 1] == '\r';
}

/// Appends the colours of one line. \return whether the line is valid.
bool add_colors(std::string_view digits, std::vector<Color>& colors) {
    constexpr std::size_t digits_per_color = 8, rgb = 0xffffff;
    for (; digits.size() >= digits_per_color; digits.remove_prefix(digits_per_color)) {
        std::uint32_t mrgb = 0;
        const char* const last = digits.data() + digits_per_color;
        const auto [end, error] = std::from_chars(digits.data(), last, mrgb, 16);
        if (error != std::errc() || end != last)
            return false;
        mrgb &= rgb;
        colors.push_back({static_cast<std::uint8_t>(mrgb >> 16), static_cast<std::uint8_t>(mrgb >> 8 & 0xff),
                          static_cast<std::uint8_t>(mrgb & 0xff), 255});
    }
    return digits.empty();
}

}

MrgbColors read_mrgb(std::string_view text) {
    constexpr std::string_view mark = "#MRGB ";
    MrgbColors result;
    for (std::size_t at = 0; (at = text.find(mark, at)) != std::string_view::npos; at += mark.size()) {
        if (!begins_line(text, at))
            continue;
        std::string_view line = text.substr(at + mark.size());
        line = line.substr(0, line.find_first_of("\r\n"));
        line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
        line = line.substr(0, line.find_last_not_of(blanks) + 1);
        ++result.lines;
        result.damaged_lines += !add_colors(line, result.colors);
    }
    return result;
}

}
