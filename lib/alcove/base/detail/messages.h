/// What messages are put together from. Internal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace alcove {

/// The text between quotes for a message: cut to 40 characters, unprintable ones shown as '?'.
std::string in_quotes(std::string_view text);

/// The text with '?' for each control character.
std::string in_one_line(std::string text);

/// 1234567 as "1,234,567".
std::string grouped(std::size_t count);

/// "1 vertex", "1,234 vertices".
std::string counted(std::size_t count, std::string_view singular, std::string_view plural);

}
