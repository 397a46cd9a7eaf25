#include "announced.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <iterator>
#include <sstream>
#include <vector>

namespace {

void replace_all(std::string& text, std::string_view from, std::string_view to) {
    std::string result;
    std::size_t at = 0;
    for (std::size_t found; (found = text.find(from, at)) != std::string::npos; at = found + from.size())
        result.append(text, at, found - at).append(to);
    text = result.append(text, at);
}

std::string with_plain_line_ends(std::string text) {
    replace_all(text, "\r\n", "\n");
    replace_all(text, "\r", "\n");
    return text;
}

/// Replaces each `beginning` and the rest of its line by a blank.
std::string without_rests_of_lines(const std::string& text, std::string_view beginning) {
    std::string result;
    std::size_t at = 0;
    for (std::size_t found; (found = text.find(beginning, at)) != std::string::npos;) {
        result.append(text, at, found - at).append(1, ' ');
        at = std::min(text.find('\n', found), text.size());
    }
    return result.append(text, at);
}

std::vector<std::string> words_of(const std::string& text) {
    std::istringstream stream(text);
    return {std::istream_iterator<std::string>(stream), {}};
}

std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

Announced by_ply(const std::string& bytes) {
    Announced result;
    for (const std::string& line : lines_of(with_plain_line_ends(bytes.substr(0, bytes.find("end_header"))))) {
        const std::vector<std::string> words = words_of(line);
        if (words.size() == 3 && words[0] == "element" && words[1] == "vertex")
            result.vertices = std::stoull(words[2]);
        if (words.size() == 3 && words[0] == "element" && words[1] == "face")
            result.faces = std::stoull(words[2]);
    }
    return result;
}

std::uint64_t big_endian_at(const std::string& bytes, std::size_t at) {
    std::uint64_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i)
        value = value * 256 + static_cast<unsigned char>(bytes[i]);
    return value;
}

Announced by_off(const std::string& bytes) {
    const std::string text = without_rests_of_lines(with_plain_line_ends(bytes), "#");
    const std::vector<std::string> words = words_of(text);
    const bool keyword = words[0].ends_with("OFF");
    if (keyword && words[1] == "BINARY") {
        const std::size_t line_end = bytes.find_first_of("\r\n", bytes.find("BINARY"));
        const std::size_t begin = line_end + (bytes.compare(line_end, 2, "\r\n") == 0 ? 2 : 1);
        return {big_endian_at(bytes, begin), big_endian_at(bytes, begin + 4)};
    }
    const std::size_t counts = (keyword ? 1u : 0u) + (words[0].ends_with("nOFF") ? 1u : 0u);
    return {std::stoull(words[counts]), std::stoull(words[counts + 1])};
}

Announced by_obj(const std::string& bytes) {
    std::string text = without_rests_of_lines(with_plain_line_ends(bytes), "#");
    replace_all(text, "\\\n", " ");
    Announced result;
    for (const std::string& line : lines_of(text)) {
        const std::vector<std::string> words = words_of(line);
        result.vertices += !words.empty() && words[0] == "v";
        result.faces += !words.empty() && (words[0] == "f" || words[0] == "fo");
    }
    return result;
}

Announced by_stl(const std::string& bytes) {
    constexpr std::size_t preamble = 84, facet = 50;
    std::uint32_t facets = 0;
    if (bytes.size() >= preamble)
        std::memcpy(&facets, bytes.data() + preamble - sizeof facets, sizeof facets);
    if (facets == 0 || facets >= 0x7fffffff) // never filled in
        facets = bytes.size() >= preamble ? static_cast<std::uint32_t>((bytes.size() - preamble) / facet) : 0;
    if (bytes.size() >= preamble && preamble + facet * std::size_t{facets} <= bytes.size())
        return {3 * std::uint64_t{facets}, facets};
    std::string text = bytes;
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    // A name follows solid and endsolid.
    text = without_rests_of_lines(with_plain_line_ends(text), "solid");
    const std::vector<std::string> words = words_of(text);
    const auto count = [&](const char* word) {
        return static_cast<std::uint64_t>(std::count(words.begin(), words.end(), word));
    };
    return {count("vertex"), count("facet")};
}

}

Announced announced_by(const std::string& bytes, std::string_view format) {
    return format == "PLY"   ? by_ply(bytes)
           : format == "OFF" ? by_off(bytes)
           : format == "OBJ" ? by_obj(bytes)
                             : by_stl(bytes);
}
