#include "alcove/mesh/formats/text_encoding.h"

#include <algorithm>
#include <string>

namespace alcove {
namespace {

using namespace std::string_view_literals;

bool is_control(char c) {
    return c >= '\0' && c < ' ' && c != '\t' && c != '\r' && c != '\n';
}

/// Whether the text has 16 bits per character, with the high byte first or last. This shows in the high bytes of plain
/// characters, which are zero.
bool is_wide(std::string_view text, bool high_first) {
    std::size_t plain = 0;
    for (std::size_t at = 0; at + 1 < text.size(); at += 2) {
        const char high = text[at + (high_first ? 0 : 1)], low = text[at + (high_first ? 1 : 0)];
        if (high == '\0' && is_control(low))
            return false;
        plain += high == '\0';
    }
    return plain >= 4 && plain >= text.size() / 4;
}

const char* wide_encoding_of(std::string_view text) {
    if (text.starts_with("\xff\xfe\0\0"sv) || text.starts_with("\0\0\xfe\xff"sv))
        return "UTF-32";
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
        return "UTF-16";
    const std::string_view start = text.substr(0, 1024);
    return is_wide(start, true) || is_wide(start, false) ? "UTF-16" : nullptr;
}

}

std::string_view without_byte_order_mark(std::string_view text) {
    constexpr std::string_view mark = "\xef\xbb\xbf";
    while (text.starts_with(mark))
        text.remove_prefix(mark.size());
    return text;
}

std::string_view without_padding(std::string_view text) {
    constexpr std::string_view padding = "\0\x1a"sv, padding_or_blanks = "\0\x1a \t\r\n"sv;
    const std::size_t last = text.find_last_not_of(padding_or_blanks);
    return text.substr(0, text.find_first_of(padding, last == std::string_view::npos ? 0 : last + 1));
}

void refuse_wide_text(const FileBytes& file) {
    if (const char* const encoding = wide_encoding_of(file.view()))
        file.fail(std::string("is text in ") + encoding + "; save it as UTF-8");
}

}
