/// The edit distance between words.
#pragma once

#include <cstddef>
#include <string_view>

namespace alcove {

/// The minimum number of insertions, deletions and replacements of letters that turn one word into the other
/// (Levenshtein 1966).
std::size_t edit_distance(std::string_view a, std::string_view b);

}
