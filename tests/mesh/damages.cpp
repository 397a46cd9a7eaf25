#include "damages.h"

#include "scratch_files.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

namespace {

constexpr std::string_view blanks = " \t\r\n";

const std::vector<std::string>& extreme_words() {
    static const std::vector<std::string> words{
        "0",     "-1",          "1.5",        "255",        "256",        "65536",
        "2e9",   "2000000000",  "2147483647", "2147483648", "4294967295", "4294967296",
        "1e38",  "-2147483649", "1e39",       "1e308",      "1e-320",     "9223372036854775808",
        "1e999", "-nan",        "nan",        "inf",        "-inf",       "99999999999999999999999",
        "",      "word",        "0x10",       "1,5",        "/",          "1//"};
    return words;
}

/// In little and big endian.
const std::vector<std::string>& extreme_numbers() {
    static const std::vector<std::string> numbers = [] {
        const float infinity = std::numeric_limits<float>::infinity();
        std::vector<std::string> little{packed(std::uint8_t(255)),
                                        packed(std::uint16_t(0xffff)),
                                        packed(0),
                                        packed(-1),
                                        packed(2000000000),
                                        packed(0x7fffffff),
                                        packed(0x80000000u),
                                        packed(std::nanf("")),
                                        packed(infinity),
                                        packed(-infinity),
                                        packed(1e38f),
                                        packed(1e-40f),
                                        packed(1e308)};
        std::vector<std::string> all = little;
        for (std::string& number : little) {
            std::reverse(number.begin(), number.end());
            all.push_back(number);
        }
        return all;
    }();
    return numbers;
}

bool is_text(const std::string& bytes) {
    return std::all_of(bytes.begin(), bytes.end(), [](char c) { return c >= ' ' || c == '\n' || c == '\r'; });
}

/// The end of the header of a binary file, or of the whole text.
std::size_t end_of_text(const std::string& bytes) {
    if (is_text(bytes))
        return bytes.size();
    constexpr std::string_view ply_end = "end_header\n", off_end = "BINARY\n";
    for (const std::string_view end : {ply_end, off_end})
        if (const std::size_t at = bytes.find(end); at != std::string::npos)
            return at + end.size();
    return 0;
}

using Visit = std::function<void(const char*, const std::string&)>;

void damage_bytes(const std::string& sound, const Visit& visit) {
    for (std::size_t length = 0; length < sound.size(); ++length)
        visit("cut", sound.substr(0, length));
    for (std::size_t at = 0; at < sound.size(); ++at) {
        std::string bytes = sound;
        bytes[at] = '\0';
        visit("byte replaced by NUL", bytes);
        visit("NUL inserted", std::string(sound).insert(at, 1, '\0'));
    }
    visit("bytes appended", sound + "more");
    visit("doubled", sound + sound);
}

void damage_lines(const std::string& sound, const Visit& visit) {
    const std::size_t end_of_lines = end_of_text(sound);
    for (std::size_t begin = 0; begin < end_of_lines;) {
        const std::size_t end = std::min(sound.find('\n', begin), end_of_lines - 1) + 1;
        const std::string line = sound.substr(begin, end - begin);
        visit("line deleted", std::string(sound).erase(begin, line.size()));
        visit("line doubled", std::string(sound).insert(begin, line));
        constexpr std::size_t huge = 100000;
        for (const char filling : {' ', 'x', '0', '#', '\\'}) {
            visit("huge line", std::string(sound).insert(begin, huge, filling));
            visit("huge end of a line", std::string(sound).insert(end - 1, huge, filling));
        }
        begin = end;
    }
    for (const char* line_end : {"\r", "\r\n", "\n\n", "\n\r", "\\\n"})
        for (const std::size_t every : {1, 2, 3}) {
            std::string bytes;
            std::size_t lines = 0;
            for (std::size_t at = 0; at < sound.size(); ++at)
                if (at < end_of_lines && sound[at] == '\n' && lines++ % every == 0)
                    bytes += line_end;
                else
                    bytes += sound[at];
            visit("line ends mixed", bytes);
        }
}

void damage_words(const std::string& sound, const Visit& visit) {
    const std::size_t end_of_words = end_of_text(sound);
    for (std::size_t end = 0;;) {
        const std::size_t begin = sound.find_first_not_of(blanks, end);
        if (begin >= end_of_words)
            return;
        end = std::min(sound.find_first_of(blanks, begin), sound.size());
        for (const std::string& word : extreme_words())
            visit("word replaced", std::string(sound).replace(begin, end - begin, word));
        visit("word doubled", std::string(sound).insert(begin, sound.substr(begin, end - begin) + " "));
    }
}

void damage_numbers(const std::string& sound, const Visit& visit) {
    const std::size_t begin = end_of_text(sound);
    for (std::size_t at = begin; at < sound.size(); ++at) {
        for (const std::string& number : extreme_numbers())
            if (number.size() <= sound.size() - at)
                visit("number replaced", std::string(sound).replace(at, number.size(), number));
        std::string reversed = sound;
        std::reverse(reversed.begin() + static_cast<std::ptrdiff_t>(at),
                     reversed.begin() + static_cast<std::ptrdiff_t>(std::min(at + 4, sound.size())));
        visit("number reversed", reversed);
    }
    for (const auto& [from, to] : {std::pair("binary_little", "binary_big"), std::pair("binary_big", "binary_little"),
                                   std::pair("binary_little_endian", "ascii"), std::pair("ascii", "binary_big_endian"),
                                   std::pair("OFF BINARY", "OFF"), std::pair("OFF\n", "OFF BINARY\n")})
        if (const std::size_t at = sound.find(from); at != std::string::npos)
            visit("encoding changed", std::string(sound).replace(at, std::strlen(from), to));
}

}

void for_each_damage(const std::string& sound, const Visit& f) {
    damage_bytes(sound, f);
    damage_lines(sound, f);
    damage_words(sound, f);
    damage_numbers(sound, f);
}
