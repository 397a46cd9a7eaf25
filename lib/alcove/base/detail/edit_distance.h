/// Similar words.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace alcove {

/// The minimum number of insertions, deletions and replacements of letters that turn one word into the other
/// (Levenshtein 1966).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The closest name at an edit distance of at most a third of the typed letters plus one; empty if there is none.
std::string nearest_name(std::string_view typed, const std::vector<std::string>& names);

}
