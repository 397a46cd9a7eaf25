/// How far one word is from another.
#pragma once

#include <cstddef>
#include <string_view>

namespace alcove {

/// Letters to put in, take out or change to make one word the other. V. I. Levenshtein, "Binary codes capable of
/// correcting deletions, insertions, and reversals" (1966).
std::size_t edit_distance(std::string_view a, std::string_view b);

}
