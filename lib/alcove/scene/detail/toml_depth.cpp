#include "alcove/scene/detail/toml_depth.h"

#include "alcove/base/types.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace alcove {
namespace {

constexpr std::size_t max_depth = 1000;

/// The end of the quoted string that starts at `at`; if it is not closed, the end of its line or of the file.
const char* end_of_string(const char* at, const char* end) {
    const auto is_quote = [quote = *at](char c) { return c == quote; };
    const auto are_three = [&](const char* first) {
        return end - first > 2 && std::all_of(first, first + 3, is_quote);
    };
    const bool is_long = are_three(at), has_escapes = *at == '"';
    for (at += is_long ? 3 : 1; at < end; ++at) {
        if (*at == '\\' && has_escapes)
            ++at;
        else if (is_long && are_three(at))
            return std::find_if_not(at, end, is_quote); // extra quotes belong to the string
        else if (!is_long && is_quote(*at))
            return at + 1;
        else if (!is_long && *at == '\n')
            return at;
    }
    return end;
}

}

void check_toml_depth(const FileBytes& file) {
    std::size_t depth = 0;
    std::vector<std::size_t> outside; // the depth before each open bracket
    for (const char* at = file.begin(); at < file.end(); ++at)
        switch (*at) {
        case '"':
        case '\'':
            at = end_of_string(at, file.end()) - 1;
            break;
        case '#':
            at = std::find(at, file.end(), '\n') - 1;
            break;
        case '[':
        case '{':
            outside.push_back(depth);
            [[fallthrough]];
        case '.':
            if (++depth > max_depth)
                throw InputError(fmt::format("{}:{}: unsupported TOML: nested more than {} deep", file.path().string(),
                                             1 + std::count(file.begin(), at, '\n'), max_depth));
            break;
        case ']':
        case '}':
            if (!outside.empty()) {
                depth = outside.back();
                outside.pop_back();
            }
            break;
        case '\n':
        case ',':
            depth = outside.empty() ? 0 : outside.back() + 1;
            break;
        default:
            break;
        }
}

}
