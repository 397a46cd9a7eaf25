/// Building blocks of messages.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace alcove {

/// The text with '?' for each byte of a control or invisible character, and for each byte that is not UTF-8, so that
/// names in a file cannot control a terminal.
std::string in_one_line(std::string_view text);

/// The result of in_one_line(), truncated to 40 characters, in single quotes.
std::string in_quotes(std::string_view text);

/// 1234567 as "1,234,567".
std::string grouped(std::size_t count);

/// A positive number rounded to `digits` significant digits. Numbers between 1e-15 and 1e15 have no exponent:
/// "0.0000123", "4.3", "53,000,000".
std::string rounded(double number, int digits);

/// A number of bytes, rounded to three digits: "20 bytes", "1.5 kB", "512 MB", "4,300 GB".
std::string bytes_text(double bytes);

/// "1 vertex", "1,234 vertices".
std::string counted(std::size_t count, std::string_view singular, std::string_view plural);

}
