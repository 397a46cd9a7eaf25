/// Explains errors of the command line in one line with a fix.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace alcove::cli {

/// The message for a parsing error. `words` are the arguments without the program name.
std::string explain(const CLI::App& program, const CLI::ParseError& error, const std::vector<std::string>& words);

/// The name with the smallest edit distance from `typed`; empty if that exceeds a third of the length of `typed` plus
/// 1.
std::string nearest(std::string_view typed, const std::vector<std::string>& names);

}
