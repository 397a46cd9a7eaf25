/// Finds similar words, to suggest corrections of typing errors.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace alcove {

/// The minimum number of insertions, deletions and replacements of letters that turn one word into the other
/// (Levenshtein 1966).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The name with the smallest edit distance from `typed`; empty if that distance exceeds typed.size() / 3 + 1.
std::string nearest_name(std::string_view typed, const std::vector<std::string>& names);

}
